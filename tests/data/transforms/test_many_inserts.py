"""The transforms of a message in one pass leave what they leave one by one."""

import math
import random
from collections.abc import Iterable

import numpy as np
import pytest

from webviz.data.transforms import TransformBuffer
from webviz.data.transforms.batches import Batches
from webviz.data.transforms.cache import TimeCache
from webviz.data.transforms.clocks import clock_problem
from webviz.data.transforms.geometry import PACKED

S = 1_000_000_000
Row = tuple[str, str, int, list[float]]


def one_by_one(buffer: TransformBuffer, rows: list[Row], authority: str, received_ns: int) -> None:
    for parent, child, stamp_ns, (x, y, z, qx, qy, qz, qw) in rows:
        buffer.set_transform(
            parent, child, stamp_ns, (x, y, z), (qx, qy, qz, qw), False, authority, received_ns
        )


def at_once(buffer: TransformBuffer, rows: list[Row], authority: str, received_ns: int) -> None:
    names = [(parent, child) for parent, child, _, _ in rows]
    poses = np.array([pose for _, _, _, pose in rows])
    buffer.set_moving(names, [stamp for _, _, stamp, _ in rows], poses, authority, received_ns)


def message(dice: random.Random, tick: int) -> list[Row]:
    """Mostly what the tick before had, later; here and there something that is new or wrong."""
    rows = []
    for i in range(8):
        parent, child, stamp = f"f{i // 2}", f"f{i + 1}", S + tick * S // 10
        pose = [dice.uniform(-9.0, 9.0) for _ in range(7)]
        match dice.randrange(40):
            case 0:
                parent = "elsewhere"
            case 1:
                stamp -= dice.choice([S // 20, S // 10, 20 * S])
            case 2:
                pose[dice.randrange(7)] = dice.choice([math.nan, math.inf])
            case 3:
                pose[3:] = [0.0] * 4
            case 4:
                child = f"/{child}"
            case 5:
                pose[3:] = dice.choice([[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.5, 0.5]])
        rows.append((parent, child, stamp, pose))
    return rows


@pytest.mark.parametrize("seed", range(20))
def test_all_at_once_is_as_one_by_one(seed: int) -> None:
    dice = random.Random(seed)
    expected, actual = TransformBuffer(2 * S), TransformBuffer(2 * S)
    has_refusal = False
    for tick in range(60):
        rows = message(dice, tick)
        authority, received_ns = dice.choice(["a", "a", "a", "b"]), (tick + 2) * S // 10
        if dice.randrange(20) == 0:
            expected.clear()
            actual.clear()
        one_by_one(expected, rows, authority, received_ns)
        at_once(actual, rows, authority, received_ns)
        assert actual.refusals.rejections == expected.refusals.rejections
        has_refusal = has_refusal or bool(actual.refusals.rejections)
    assert has_refusal
    assert_same(actual, expected, expected.tree.caches)


LISTS: list[list[tuple[str, str]]] = [
    [(f"f{i // 2}", f"f{i + 1}") for i in range(8)],
    [("f0", f"g{i}") for i in range(6)],
    [("f0", "f1"), ("g1", "h"), ("g1", "h"), ("h", "k")],
]
"""Recurring ones: the last shares a frame with the first, and has one twice."""


@pytest.mark.parametrize("seed", range(30))
def test_recurring_lists_are_as_one_by_one_whatever_is_read_meanwhile(seed: int) -> None:
    dice = random.Random(seed)
    expected, actual = TransformBuffer(2 * S), TransformBuffer(2 * S)
    is_rare = seed % 3  # of the last list, which takes frames away from the others
    followed = 0
    for tick in range(120):
        names = LISTS[dice.randrange(3 if is_rare == 0 or dice.randrange(9) == 0 else 2)]
        stamps = [S + tick * S // 10] * len(names)
        poses = [[dice.uniform(-9.0, 9.0) for _ in range(7)] for _ in names]
        odd = dice.randrange(len(names))
        match dice.randrange(30):
            case 0:
                stamps[odd] += dice.choice([-S // 20, -S, -20 * S, S // 20, 20 * S])
            case 1:
                poses[odd][dice.randrange(7)] = dice.choice([math.nan, math.inf])
            case 2:
                stamps = [ns - S // 10 for ns in stamps]
        rows = [(*pair, ns, pose) for pair, ns, pose in zip(names, stamps, poses, strict=True)]
        match dice.randrange(60):
            case 0:
                expected.clear()
                actual.clear()
            case 1:  # another publisher, or another parent
                single = [(dice.choice(["f0", "e"]), "g2", stamps[0] + 1, poses[0])]
                one_by_one(expected, single, "b", 0)
                one_by_one(actual, single, "b", 0)
            case 2:
                one_by_one(expected, [("f0", f"new{tick}", S, poses[0])], "a", 0)
                one_by_one(actual, [("f0", f"new{tick}", S, poses[0])], "a", 0)
        received_ns = dice.choice([0, stamps[0] + S // 7])
        one_by_one(expected, rows, "a", received_ns)
        actual.set_moving(names, stamps, np.array(poses), "a", received_ns)
        followed += any(isinstance(c, TimeCache) and c.batches for c in actual.tree.caches.values())
        read = dice.sample(sorted(expected.tree.caches), dice.randrange(3))
        assert_same(actual, expected, read)
        ns = stamps[0] - dice.randrange(2 * S)
        for frame in read:
            assert actual.can_transform("f0", frame, ns) == expected.can_transform("f0", frame, ns)
        frames = expected.frames() * 9  # many are computed with arrays
        many, others = actual.poses_in("f0", frames), expected.poses_in("f0", frames)
        np.testing.assert_array_equal(many.stamps_ns, others.stamps_ns)
        np.testing.assert_allclose(many.translations, others.translations, atol=1e-9)
        np.testing.assert_allclose(many.rotations, others.rotations, atol=1e-9)
        assert list(actual.conflicts.all()) == list(expected.conflicts.all())
        assert clock_problem(actual, stamps[0]) == clock_problem(expected, stamps[0])
    assert followed > 60
    assert_same(actual, expected, expected.tree.caches)


def assert_same(actual: TransformBuffer, expected: TransformBuffer, frames: Iterable[str]) -> None:
    """Compare the frames of two buffers, and all histories and publishers of some of them."""
    assert actual.frames() == expected.frames()
    assert actual.version == expected.version
    assert actual.structure_version == expected.structure_version
    for child in frames:
        cache, other = expected.tree.caches[child], actual.tree.caches[child]
        assert isinstance(cache, TimeCache)
        assert isinstance(other, TimeCache)
        assert other.newest_stamp == cache.newest_stamp
        assert (other.newest is None) == (cache.newest is None)
        if other.newest and cache.newest:
            assert other.newest[0] == pytest.approx(cache.newest[0], abs=1e-12)
            assert other.newest[1] == cache.newest[1]
        assert (other.is_single, other.delay_ns) == (cache.is_single, cache.delay_ns)
        assert other.stamps == cache.stamps
        assert other.parents == cache.parents
        for pose, other_pose in zip(cache.poses, other.poses, strict=True):
            assert PACKED.unpack(other_pose) == pytest.approx(PACKED.unpack(pose), abs=1e-12)
        whose, others = expected.publishers[child], actual.publishers[child]
        assert (others.current, others.claim) == (whose.current, whose.claim)
        assert others.contest == whose.contest


def test_messages_are_kept_for_the_cache_time_although_nobody_reads_a_history() -> None:
    buffer, names = TransformBuffer(2 * S), LISTS[0]
    for tick in range(200):
        poses = np.tile([float(tick), 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (len(names), 1))
        buffer.set_moving(names, [S + tick * S // 10] * len(names), poses, "a", 0)
    cache = buffer.tree.caches["f8"]
    assert isinstance(cache, TimeCache)
    assert cache.batches is not None
    assert (
        len(cache.batches.since(0, cache.place)) == 22
    )  # 2 s before the last but one, and the last
    assert list(cache.stamps) == [S + tick * S // 10 for tick in range(178, 200)]
    assert buffer.lookup("f0", "f8", S + 19 * S).translation == (570.0, 0.0, 0.0)


def test_a_frame_of_many_that_alternates_between_two_poses_is_found() -> None:
    buffer, names = TransformBuffer(2 * S), LISTS[0]
    poses = np.tile([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (len(names), 1))
    for tick in range(10):
        poses[:, 0] = tick
        poses[3, 0] = 100.0 * (tick % 2)
        buffer.set_moving(names, [S + tick * S // 10] * len(names), poses.copy(), "a", 0)
        list(buffer.conflicts.all())
    assert [frame for frame, _ in buffer.conflicts.all()] == ["f4"]


def test_no_more_messages_are_kept_than_samples_of_a_frame_whatever_their_stamps() -> None:
    changes: list[int] = []
    batches = Batches(2, 100 * S, 4, lambda: changes.append(1))
    batches.follow(0, 0)
    for tick in range(1, 9):
        batches.add(np.array([tick, 0]), np.full((2, 7), float(tick)), 0)
    assert [ns for ns, _ in batches.since(0, 0)] == [5, 6, 7, 8]
    assert [ns for ns, _ in batches.since(6, 0)] == [7, 8]
    assert changes


def test_frames_follow_a_list_that_takes_the_place_of_another() -> None:
    buffer, names = TransformBuffer(2 * S), LISTS[0]
    poses = np.tile([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (len(names), 1))
    other = list(reversed(names))  # of the same publisher, started anew
    for tick in range(9):
        stamps = [S + tick * S // 10] * len(names)
        buffer.set_moving(names if tick < 4 else other, stamps, poses, "a", 0)
    cache = buffer.tree.caches["f8"]
    assert isinstance(cache, TimeCache)
    assert cache.batches is not None
    assert cache.place == other.index(("f3", "f8"))
    assert len(cache) == 9
