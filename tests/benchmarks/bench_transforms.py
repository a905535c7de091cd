"""Speed of the transform buffer, next to straightforward ways, in one run.

    python tests/benchmarks/bench_transforms.py

Microseconds depend on the machine and the hour; the ratios are what to compare. Ours and theirs
take turns, in processor time, and of the rounds the best and the median are shown. The naive buffer
is what one writes first: a list of numpy poses per frame, searched and interpolated with numpy,
chains multiplied as 4x4 matrices.
"""

from __future__ import annotations

import random
import statistics
import time
import timeit
from collections.abc import Callable

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from webviz.data.transforms import TransformBuffer

S = 1_000_000_000
ROUNDS = 5
DEPTH = 6
SAMPLES = 1000
STEP_NS = 10_000_000
STAMPS = 10_000
FRAMES = 200

Row = tuple[str, str, int, tuple[float, float, float], tuple[float, float, float, float]]


class NaiveBuffer:
    """Straightforward: numpy for everything, no pruning, no validation."""

    def __init__(self) -> None:
        self.frames: dict[str, tuple[str, list[int], list[np.ndarray]]] = {}

    def set_transform(self, parent: str, child: str, stamp: int, xyz: object, q: object) -> None:
        _, stamps, poses = self.frames.setdefault(child, (parent, [], []))
        pose = np.concatenate((np.asarray(xyz, float), np.asarray(q, float)))
        pose[3:] /= np.linalg.norm(pose[3:])
        i = int(np.searchsorted(stamps, stamp)) if stamps and stamp < stamps[-1] else len(stamps)
        stamps.insert(i, stamp)
        poses.insert(i, pose)

    def lookup(self, root: str, frame: str, stamp: int) -> np.ndarray:
        out = np.eye(4)
        while frame != root:
            parent, stamps, poses = self.frames[frame]
            i = int(np.searchsorted(stamps, stamp, side="right"))
            a, b = poses[i - 1], poses[min(i, len(poses) - 1)]
            ratio = (stamp - stamps[i - 1]) / max(stamps[min(i, len(poses) - 1)] - stamps[i - 1], 1)
            dot = float(np.dot(a[3:], b[3:]))
            theta = np.arccos(min(abs(dot), 1.0))
            weights = (1 - ratio, ratio)
            if theta > 1e-9:
                weights = np.sin([(1 - ratio) * theta, ratio * theta]) / np.sin(theta)
            x, y, z, w = weights[0] * a[3:] + np.copysign(weights[1], dot) * b[3:]
            link = np.eye(4)
            link[:3, :3] = [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
            link[:3, 3] = (1 - ratio) * a[:3] + ratio * b[:3]
            frame, out = parent, link @ out
        return out


def scipy_lookup(history: dict[str, list[Row]], root: str, frame: str, stamp: int) -> np.ndarray:
    """The pose of a frame from the two samples around a time on each link, by scipy's Slerp."""
    out = np.eye(4)
    while frame != root:
        before, after = history[frame]
        ends = Rotation.from_quat([before[4], after[4]])
        ratio = (stamp - before[2]) / (after[2] - before[2])
        link = np.eye(4)
        link[:3, :3] = Slerp([0.0, 1.0], ends)([ratio])[0].as_matrix()
        link[:3, 3] = (1 - ratio) * np.array(before[3]) + ratio * np.array(after[3])
        frame, out = before[0], link @ out
    return out


def pose(dice: random.Random) -> tuple[tuple[float, float, float], tuple[float, ...]]:
    rotation = Rotation.from_rotvec([dice.uniform(-1, 1) for _ in range(3)]).as_quat()
    return (dice.random(), dice.random(), dice.random()), tuple(rotation.tolist())


def rows_of(parents: dict[str, str], samples: int) -> list[Row]:
    """Samples of every link, stamped a little apart as those of several publishers are."""
    dice = random.Random(1)
    rows = []
    for k in range(samples):
        for i, (child, parent) in enumerate(parents.items()):
            xyz, q = pose(dice)
            rows.append((parent, child, S + k * STEP_NS + i, xyz, q))
    return rows


def show(
    what: str,
    ours: Callable[[], object],
    other: str,
    theirs: Callable[[], object],
    calls: tuple[int, int] = (1, 1),
) -> None:
    """Print microseconds of one call of each, and how much faster ours is."""
    runs = (ours, theirs)
    rounds = [
        [timeit.timeit(run, number=1, timer=time.process_time) * 1e6 for run in runs]
        for _ in range(ROUNDS + 1)
    ][1:]
    ratios = [(b / calls[1]) / (a / calls[0]) for a, b in rounds]
    quickest = [min(column) / n for column, n in zip(zip(*rounds, strict=True), calls, strict=True)]
    print(
        f"{what:<44}{quickest[0]:>9.1f} us {quickest[1]:>10.1f} us {min(ratios):>8.1f} "
        f"{statistics.median(ratios):>8.1f}  {other}"
    )


def filled(kind: type, rows: list[Row]) -> TransformBuffer | NaiveBuffer:
    buffer = kind()
    for row in rows:
        buffer.set_transform(*row)
    return buffer


def chain() -> None:
    """One chain of moving links: inserts, single lookups, many stamps."""
    rows = rows_of({f"f{i + 1}": f"f{i}" for i in range(DEPTH)}, SAMPLES)
    last = f"f{DEPTH}"
    ours, naive = filled(TransformBuffer, rows), filled(NaiveBuffer, rows)
    assert isinstance(ours, TransformBuffer)
    dice = random.Random(2)
    stamps = [S + dice.randrange(STEP_NS, (SAMPLES - 1) * STEP_NS) for _ in range(STAMPS)]
    few = stamps[:1000]
    show(
        "insert",
        lambda: filled(TransformBuffer, rows),
        "naive buffer",
        lambda: filled(NaiveBuffer, rows),
        (len(rows), len(rows)),
    )
    show(
        f"lookup, interpolated, {DEPTH} links",
        lambda: [ours.lookup("f0", last, stamp) for stamp in few],
        "naive buffer",
        lambda: [naive.lookup("f0", last, stamp) for stamp in few],
        (len(few), len(few)),
    )
    for order, asked in (("in order", sorted(stamps)), ("in any order", stamps)):
        array = np.array(asked)
        show(
            f"{STAMPS} stamps {order}, {DEPTH} moving links",
            lambda array=array: ours.lookup_many("f0", last, array),
            "lookup in a loop",
            lambda asked=asked: [ours.lookup("f0", last, stamp) for stamp in asked],
        )


def tree() -> None:
    """All frames of a tree to its root."""
    parents = {f"f{i}": f"f{(i - 1) // 2}" for i in range(1, FRAMES)}
    rows = rows_of(parents, 50)
    buffer = filled(TransformBuffer, rows)
    assert isinstance(buffer, TransformBuffer)
    history = {child: [row for row in rows if row[1] == child][-2:] for child in parents}
    newest = S + 49 * STEP_NS
    for what, stamp in (("at one time", newest - STEP_NS // 2), ("at latest common times", 0)):
        asked = stamp or newest - STEP_NS // 2

        def at_once(stamp: int = stamp) -> object:
            return buffer.poses_in("f0", None, stamp)

        show(
            f"{FRAMES} frames {what}",
            at_once,
            f"{FRAMES} scipy lookups",
            lambda asked=asked: [scipy_lookup(history, "f0", f, asked) for f in parents],
        )
        show(
            f"{FRAMES} frames {what}",
            at_once,
            "lookup in a loop",
            lambda stamp=stamp: [buffer.lookup("f0", f, stamp) for f in parents],
        )


def main() -> None:
    """Print a table; a ratio, the least of all rounds, of more than 1 means that ours is faster."""
    print(f"{'':<44}{'ours':>12} {'other':>13} {'ratio':>8} {'median':>8}")
    chain()
    tree()


if __name__ == "__main__":
    main()
