"""The buffer, its vectorised questions, and an independent model on scipy, on random histories.

The model is as straightforward as can be: it keeps everything it is given, walks names, and leaves
all rotations to scipy.
"""

import random

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from webviz.data.transforms import TransformBuffer, TransformException, many_frames, many_stamps

UNKNOWN = None


class Model:
    """Transforms as 4x4 matrices; raises KeyError wherever there is no answer."""

    def __init__(self) -> None:
        self.links: dict[str, list[tuple[int, str, np.ndarray]]] = {}
        self.static: dict[str, tuple[str, np.ndarray]] = {}

    def put(self, parent: str, child: str, stamp: int, pose: np.ndarray, is_static: bool) -> None:
        if is_static:
            self.static[child] = (parent, pose)
        else:
            samples = self.links.setdefault(child, [])
            samples.append((stamp, parent, pose))
            samples.sort(key=lambda sample: sample[0])

    def newest(self, frame: str) -> tuple[int, str] | None:
        if frame in self.static:
            return 0, self.static[frame][0]
        if frame in self.links:
            return self.links[frame][-1][:2]
        return None

    def link(self, frame: str, stamp: int) -> tuple[str, np.ndarray]:
        if frame in self.static:
            return self.static[frame]
        samples = self.links[frame]
        if stamp == 0:
            return samples[-1][1:]
        stamps = [sample[0] for sample in samples]
        if stamp in (stamps[0], stamps[-1]):
            return samples[stamps.index(stamp)][1:]
        before = [sample for sample in samples if sample[0] <= stamp]
        after = [sample for sample in samples if sample[0] > stamp]
        if not before or not after:
            raise KeyError(frame)
        (t0, parent, a), (t1, other, b) = before[-1], after[0]
        if parent != other:
            return parent, a
        ratio = (stamp - t0) / (t1 - t0)
        out = np.eye(4)
        ends = Rotation.from_matrix([a[:3, :3], b[:3, :3]])
        out[:3, :3] = Slerp([0.0, 1.0], ends)(ratio).as_matrix()
        out[:3, 3] = (1 - ratio) * a[:3, 3] + ratio * b[:3, 3]
        return parent, out

    def climb(self, frame: str, stamp: int, stop: str) -> tuple[str, np.ndarray]:
        pose = np.eye(4)
        while frame != stop:
            try:
                parent, link = self.link(frame, stamp)
            except KeyError:
                break
            frame, pose = parent, link @ pose
        return frame, pose

    def common_time(self, target: str, source: str) -> int:
        def path(frame: str) -> list[str]:
            names = [frame]
            while (newest := self.newest(frame)) is not None:
                frame = newest[1]
                names.append(frame)
            return names

        up, down = path(source), path(target)
        meeting = next((name for name in up if name in down), UNKNOWN)
        if meeting is None:
            raise KeyError(source)
        used = up[: up.index(meeting)] + down[: down.index(meeting)]
        stamps = [newest[0] for name in used if (newest := self.newest(name)) is not None]
        return min((stamp for stamp in stamps if stamp), default=0)

    def lookup(self, target: str, source: str, stamp: int) -> tuple[np.ndarray, int]:
        if stamp == 0:
            stamp = self.common_time(target, source)
        top, pose = self.climb(source, stamp, target)
        other_top, other = self.climb(target, stamp, top)
        if top != other_top:
            raise KeyError(source)
        return np.linalg.inv(other) @ pose, stamp


def history(seed: int) -> tuple[TransformBuffer, Model, list[str], random.Random, int]:
    """A buffer and a model told the same: a tree of up to 12 frames, some static, some late."""
    dice = random.Random(seed)
    buffer, model = TransformBuffer(), Model()
    names = [f"f{i}" for i in range(dice.randint(2, 12))]
    static = {name for name in names if dice.random() < 0.25}
    start = dice.choice([10**9, 1_700_000_000 * 10**9])
    for _ in range(dice.randint(20, 200)):
        i = dice.randrange(1, len(names))
        parent = names[dice.randrange(i) if dice.random() < 0.05 else (i - 1) // 2]
        quaternion = [dice.gauss(0, 1) for _ in range(4)]
        pose = np.eye(4)
        pose[:3, :3] = Rotation.from_quat(quaternion).as_matrix()
        pose[:3, 3] = x, y, z = [dice.uniform(-5, 5) for _ in range(3)]
        stamp = start + dice.randrange(10**9)
        qx, qy, qz, qw = quaternion
        is_static = names[i] in static
        assert buffer.set_transform(parent, names[i], stamp, (x, y, z), (qx, qy, qz, qw), is_static)
        model.put(parent, names[i], stamp, pose, is_static)
    return buffer, model, buffer.frames(), dice, start


@pytest.mark.parametrize("seed", range(60))
def test_every_lookup_agrees_with_the_model(seed: int) -> None:
    buffer, model, names, dice, start = history(seed)
    answered = 0
    for _ in range(60):
        target, source = dice.choice(names), dice.choice(names)
        stamp = dice.choice([0, start + dice.randrange(10**9)])
        try:
            expected, expected_stamp = model.lookup(target, source, stamp)
        except KeyError:
            assert not buffer.can_transform(target, source, stamp) or target == source
            continue
        transform = buffer.lookup(target, source, stamp)
        answered += 1
        assert transform.translation == pytest.approx(expected[:3, 3], abs=1e-9)
        rotation = Rotation.from_quat(transform.rotation).as_matrix()
        assert rotation == pytest.approx(expected[:3, :3], abs=1e-9)
        if target != source:
            assert transform.stamp_ns == expected_stamp
    assert answered


@pytest.mark.parametrize("block", [3, many_stamps.BLOCK])
@pytest.mark.parametrize("seed", range(30))
def test_many_stamps_at_once_agree_with_one_at_a_time(
    seed: int, block: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(many_stamps, "BLOCK", block)
    buffer, _, names, dice, start = history(seed)
    for _ in range(10):
        target, source = dice.choice(names), dice.choice([*names, "unknown", "/slash"])
        stamps = [dice.choice([0, start + dice.randrange(10**9)]) for _ in range(25)]
        translations, rotations, ok = buffer.lookup_many(target, source, np.array(stamps))
        for i, stamp in enumerate(stamps):
            assert ok[i] == buffer.can_transform(target, source, stamp)
            if ok[i]:
                one = buffer.lookup(target, source, stamp)
                assert translations[i] == pytest.approx(one.translation, abs=1e-9)
                assert rotations[i] == pytest.approx(one.rotation, abs=1e-9)
            else:
                assert np.isnan(translations[i]).all()
                assert np.isnan(rotations[i]).all()


@pytest.mark.parametrize("arrays_pay_from", [0, 10**9], ids=["arrays", "floats"])
@pytest.mark.parametrize("seed", range(30))
def test_many_frames_at_once_agree_with_one_at_a_time(
    seed: int, arrays_pay_from: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(many_frames, "ARRAYS_PAY_FROM", arrays_pay_from)
    buffer, _, names, dice, start = history(seed)
    for target in (*names[:4], "unknown", "/slash"):
        for stamp in (0, start + dice.randrange(10**9)):
            frames = None if stamp == 0 else [*names[:5], "unknown", "", target, target]
            poses = buffer.poses_in(target, frames, stamp)
            assert poses.frames == (frames or names)
            for i, frame in enumerate(poses.frames):
                try:
                    one = buffer.lookup(target, frame, stamp)
                except TransformException:
                    assert not poses.ok[i]
                    continue
                assert poses.ok[i]
                assert poses.stamps_ns[i] == one.stamp_ns
                assert poses.translations[i] == pytest.approx(one.translation, abs=1e-9)
                assert poses.rotations[i] == pytest.approx(one.rotation, abs=1e-9)


def test_a_tree_that_goes_on_growing_and_changing_is_answered_as_one_at_a_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(many_frames, "ARRAYS_PAY_FROM", 0)
    buffer, dice = TransformBuffer(), random.Random(7)
    answered = 0
    for tick in range(150):
        child = dice.randrange(1, 9)
        parent, stamp = dice.randrange(child), 10**9 + tick * 10**7 - dice.choice([0, 5 * 10**6])
        buffer.set_transform(
            f"f{parent}",
            f"f{child}",
            dice.choice([stamp, 0]) if child == 8 else stamp,
            (dice.random(), dice.random(), 0.0),
            (0.0, 0.0, dice.random(), 1.0),
            is_static=child in (3, 4),
        )
        if tick == 100:
            buffer.clear()
        for target in ("f0", "f5"):
            poses = buffer.poses_in(target)
            for i, frame in enumerate(poses.frames):
                assert poses.ok[i] == buffer.can_transform(target, frame, 0) or frame == target
                if poses.ok[i]:
                    one = buffer.lookup(target, frame, 0)
                    assert poses.stamps_ns[i] == one.stamp_ns
                    assert poses.translations[i] == pytest.approx(one.translation, abs=1e-9)
                    assert poses.rotations[i] == pytest.approx(one.rotation, abs=1e-9)
                    answered += 1
    assert answered > 1000


def test_frames_in_a_loop_are_answered_as_one_at_a_time() -> None:
    buffer = TransformBuffer()
    unit = (1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
    for parent, child in (("a", "b"), ("b", "c"), ("c", "a"), ("a", "tail"), ("map", "odom")):
        buffer.set_transform(parent, child, 10**9, *unit)
    for target in buffer.frames():
        for stamp in (0, 10**9):
            poses = buffer.poses_in(target, None, stamp)
            many = [buffer.lookup_many(target, f, np.array([stamp]))[2][0] for f in poses.frames]
            one = [buffer.can_transform(target, frame, stamp) for frame in poses.frames]
            assert poses.ok.tolist() == one == many


@pytest.mark.parametrize("arrays_pay_from", [0, 10**9], ids=["arrays", "floats"])
@pytest.mark.parametrize("seed", range(20))
def test_frames_of_any_graph_are_answered_as_one_at_a_time(
    seed: int, arrays_pay_from: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(many_frames, "ARRAYS_PAY_FROM", arrays_pay_from)
    buffer, dice = TransformBuffer(), random.Random(seed)
    for child in dice.sample(range(12), 11):  # loops of all lengths, with trees below them
        parent = (child + dice.randrange(1, 12)) % 12
        pose = (dice.random(), 1.0, 2.0), (0.0, 0.0, dice.random(), 1.0)
        stamps = [10**9] if dice.random() < 0.3 else [10**9, 2 * 10**9]
        for stamp in stamps:
            buffer.set_transform(f"f{parent}", f"f{child}", stamp, *pose)
    for target in buffer.frames():
        for stamp in (0, 10**9, 15 * 10**8):
            poses = buffer.poses_in(target, None, stamp)
            for i, frame in enumerate(poses.frames):
                assert poses.ok[i] == buffer.can_transform(target, frame, stamp)
                if poses.ok[i]:
                    one = buffer.lookup(target, frame, stamp)
                    assert poses.stamps_ns[i] == one.stamp_ns
                    assert poses.translations[i] == pytest.approx(one.translation, abs=1e-9)
                    assert poses.rotations[i] == pytest.approx(one.rotation, abs=1e-9)


def test_no_stamps_give_no_poses() -> None:
    buffer = TransformBuffer()
    buffer.set_transform("a", "b", 10**9, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    translations, rotations, ok = buffer.lookup_many("a", "b", np.array([], np.int64))
    assert (translations.shape, rotations.shape, ok.shape) == ((0, 3), (0, 4), (0,))
