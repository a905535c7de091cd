"""The poses of all frames of a tick in one pass, link by link."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.transforms.arrays import (
    C128,
    F64,
    canonical_many,
    compose_many,
    interpolate_many,
    interpolation_table,
    inverse_many,
    poses_to_rows,
    to_rows,
)
from webviz.data.transforms.geometry import (
    IDENTITY,
    PoseTuple,
    canonical,
    compose,
    interpolate,
    inverse,
)
from webviz.data.transforms.tree import FrameTree

ARRAYS_PAY_FROM = 75
"""Links, or frames, from which numpy is faster than floats (measured: see the benchmark)."""


class FramesIn(msgspec.Struct, frozen=True):
    """The poses of frames in one target frame.

    Attributes:
        frames: frame ids.
        translations: float64 (N, 3), metres.
        rotations: float64 (N, 4), unit quaternions (x, y, z, w).
        stamps_ns: int64 (N,), the time each pose holds for; 0 if all its links are static.
        ok: bool (N,), whether `lookup` would succeed; the other rows are NaN.
    """

    frames: list[str]
    translations: F64
    rotations: F64
    stamps_ns: NDArray[np.int64]
    ok: NDArray[np.bool_]

    @classmethod
    def of(cls, frames: list[str], rows: F64, stamps_ns: NDArray[np.int64]) -> FramesIn:
        """Return the frames of poses as rows (7, N), NaN where there is none."""
        return cls(frames, rows[:3].T.copy(), rows[3:].T.copy(), stamps_ns, ~np.isnan(rows[6]))


class _Links(msgspec.Struct):
    """Links at some time, each once, a link's parent before it; from a top down to the frames.

    A top is a root, or the frame below a link that has no data at the time.
    """

    starts: list[PoseTuple] = msgspec.field(default_factory=list)
    ends: list[PoseTuple] = msgspec.field(default_factory=list)
    """The same object as in `starts` if no interpolation is needed."""
    ratios: list[float] = msgspec.field(default_factory=list)
    parents: list[int] = msgspec.field(default_factory=list)
    depths: list[int] = msgspec.field(default_factory=list)
    tops: list[int] = msgspec.field(default_factory=list)

    def chain(self, tree: FrameTree, frame: str, stamp_ns: int, numbers: dict[str, int]) -> int:
        """Add the link that ends in a frame and all above it; its number, -1 for a loop.

        `numbers` has the numbers of the links already added for this time; 0 is the newest of each.
        """
        climbed: list[tuple[str, PoseTuple, PoseTuple, float]] = []
        while (number := numbers.get(frame)) is None:
            cache = tree.caches.get(frame)
            bracket = cache.bracket(stamp_ns) if cache is not None else None
            if bracket is None:
                number = self.top(frame, numbers)
                break
            numbers[frame] = -1  # met again before it gets its number: a loop
            start, end, ratio, parent = bracket
            climbed.append((frame, start, end, ratio))
            frame = parent
        if number < 0:
            return number
        top, depth = self.tops[number], self.depths[number]
        for frame, start, end, ratio in reversed(climbed):
            depth += 1
            parent_number, number = number, len(self.starts)
            numbers[frame] = number
            self._append(start, end, ratio, parent_number, depth, top)
        return number

    def top(self, frame: str, numbers: dict[str, int]) -> int:
        """Add a frame as a top; its number."""
        number = numbers[frame] = len(self.starts)
        self._append(IDENTITY, IDENTITY, 0.0, -1, 0, number)
        return number

    def _append(
        self, start: PoseTuple, end: PoseTuple, ratio: float, parent: int, depth: int, top: int
    ) -> None:
        self.starts.append(start)
        self.ends.append(end)
        self.ratios.append(ratio)
        self.parents.append(parent)
        self.depths.append(depth)
        self.tops.append(top)

    def poses_by_floats(self) -> list[PoseTuple]:
        """Return the pose of every frame in its top."""
        poses: list[PoseTuple] = []
        for start, end, ratio, parent in zip(
            self.starts, self.ends, self.ratios, self.parents, strict=True
        ):
            link = start if end is start else interpolate(start, end, ratio)
            above = poses[parent] if parent >= 0 else IDENTITY
            poses.append(link if above is IDENTITY else compose(above, link))
        return poses

    def poses_by_arrays(self) -> C128:
        """Return the same as pairs (4, links): interpolated at once, then joined by level."""
        table = interpolation_table(poses_to_rows(self.starts), poses_to_rows(self.ends))
        poses = interpolate_many(table, np.array(self.ratios))
        parents, depths = np.array(self.parents), np.array(self.depths)
        by_depth = np.argsort(depths, kind="stable")
        borders = np.searchsorted(depths[by_depth], np.arange(2, depths.max() + 2))
        for low, high in pairwise(borders):
            level = by_depth[low:high]
            poses[:, level] = compose_many(poses[:, parents[level]], poses[:, level])
        return poses


def poses_in(
    tree: FrameTree, target: str, frames: list[str], valid: set[str], stamp_ns: int
) -> FramesIn:
    """`TransformBuffer.poses_in`; `valid` are those frames that can be looked up at all."""
    links = _Links()
    out = np.full((7, len(frames)), np.nan)
    by_stamp: dict[int, dict[str, int]] = {}
    indices: list[int] = []
    pairs: list[tuple[int, int]] = []
    stamps = _stamps(tree, target, frames, stamp_ns)
    for i, (frame, stamp) in enumerate(zip(frames, stamps, strict=True)):
        if frame == target:
            out[:, i] = IDENTITY
            continue
        if stamp is None or frame not in valid:
            continue
        if (at_stamp := by_stamp.get(stamp)) is None:
            at_stamp = by_stamp[stamp] = {}
            if links.chain(tree, target, stamp, at_stamp) < 0:
                # Of the frames in and below a loop only those below the target have a pose.
                at_stamp.clear()
                links.top(target, at_stamp)
        if (number := at_stamp.get(frame)) is None:
            number = links.chain(tree, frame, stamp, at_stamp)
        base = at_stamp[target]
        if number >= 0 and links.tops[number] == links.tops[base]:
            indices.append(i)
            pairs.append((base, number))

    if len(links.starts) < ARRAYS_PAY_FROM:
        floats = links.poses_by_floats()
        for i, (base, number) in zip(indices, pairs, strict=True):
            pose = compose(inverse(floats[base]), floats[number])
            out[:, i] = (*pose[:3], *canonical(*pose[3:]))
    elif indices:
        arrays = links.poses_by_arrays()
        bases, numbers = np.array(pairs).T
        rows = to_rows(compose_many(inverse_many(arrays[:, bases]), arrays[:, numbers]))
        out[:3, indices] = rows[:3]
        out[3:, indices] = canonical_many(rows[3:])
    return FramesIn.of(frames, out, np.array([stamp or 0 for stamp in stamps], np.int64))


def _stamps(tree: FrameTree, target: str, frames: list[str], stamp_ns: int) -> Sequence[int | None]:
    """Return the time at which to look up each frame; None if there is none."""
    if stamp_ns != 0:
        return [stamp_ns] * len(frames)
    caches = tree.caches
    spine: dict[str, int | None] = {}  # from target upwards -> newest common time up to there
    frame: str = target
    common: int | None = None
    while frame not in spine:
        spine[frame] = common
        cache = caches.get(frame)
        if cache is None or (parent := cache.parent) is None:
            break
        common = _older(common, cache.newest_stamp)
        frame = parent
    else:
        # Chains that meet a loop do not end: only those through the target itself have a time.
        spine = {target: None}

    meets: dict[str, tuple[str, int | None] | None] = {frame: (frame, None) for frame in spine}
    stamps: list[int | None] = []
    for name in frames:
        if name == target:
            stamps.append(tree.latest_common_time(target, target))
            continue
        climbed: list[tuple[str, int]] = []
        frame = name
        while frame not in meets:
            meets[frame] = None  # stays None for other roots and loops
            cache = caches.get(frame)
            if cache is None or (parent := cache.parent) is None:
                break
            climbed.append((frame, cache.newest_stamp))
            frame = parent
        meet = meets[frame]
        if meet is None:
            stamps.append(None)
            continue
        for frame, stamp in reversed(climbed):
            meet = meets[frame] = (meet[0], _older(meet[1], stamp))
        below, above = meet[1], spine[meet[0]]
        stamps.append(_older(below, above or 0) or 0)
    return stamps


def _older(common: int | None, stamp: int) -> int | None:
    """Return the older of the two; a stamp of 0 does not count."""
    return stamp if stamp != 0 and (common is None or stamp < common) else common
