"""The samples of one frame: tf2's cache_unittest and static_cache_test, and more."""

import math
import random

import pytest

from webviz.data.transforms.cache import MAX_SAMPLES, ParentedPose, StaticCache, TimeCache
from webviz.data.transforms.errors import (
    BackwardExtrapolationException,
    ForwardExtrapolationException,
    NoDataForExtrapolationException,
)
from webviz.data.transforms.geometry import PACKED, PoseTuple, interpolate

FAR = 10**18


def pose(x: float = 0.0, yaw: float = 0.0) -> PoseTuple:
    return (x, 0.0, 0.0, 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def filled(stamps: list[int], cache_time_ns: int = FAR) -> TimeCache:
    cache = TimeCache(cache_time_ns)
    for stamp in stamps:
        cache.insert(stamp, (pose(float(stamp)), "parent"))
    return cache


def samples(cache: TimeCache) -> list[ParentedPose]:
    return list(zip(map(PACKED.unpack, cache.poses), cache.parents, strict=True))


def test_samples_are_ordered_by_stamp_in_any_order_of_arrival() -> None:
    assert list(filled([5, 1, 4, 2, 3]).stamps) == [1, 2, 3, 4, 5]


def test_an_exact_duplicate_is_accepted_but_not_kept_twice() -> None:
    cache = filled([1, 2, 3])
    assert cache.insert(2, (pose(2.0), "parent"))
    assert list(cache.stamps) == [1, 2, 3]


def test_another_pose_or_parent_at_the_same_stamp_is_kept_beside_the_first() -> None:
    cache = filled([1])
    assert cache.insert(1, (pose(9.0), "parent"))
    assert cache.insert(1, (pose(9.0), "other"))
    assert [(p[0], parent) for p, parent in samples(cache)] == [
        (1.0, "parent"),
        (9.0, "parent"),
        (9.0, "other"),
    ]


def test_old_samples_are_pruned_by_the_newest_stamp_before_the_insert() -> None:
    cache = filled([0, 4, 8, 14], cache_time_ns=10)
    assert list(cache.stamps) == [0, 4, 8, 14]
    cache.insert(15, (pose(), "parent"))
    assert list(cache.stamps) == [4, 8, 14, 15]


def test_a_sample_exactly_as_old_as_the_cache_time_is_kept_and_an_older_one_refused() -> None:
    cache = filled([20], cache_time_ns=10)
    assert cache.insert(10, (pose(), "parent"))
    assert not cache.insert(9, (pose(), "parent"))
    assert list(cache.stamps) == [10, 20]


def test_a_refused_sample_still_prunes() -> None:
    cache = filled([1, 100], cache_time_ns=10)
    assert list(cache.stamps) == [1, 100]
    assert not cache.insert(2, (pose(), "parent"))
    assert list(cache.stamps) == [100]


def test_one_old_sample_survives_a_jump_until_the_next_insert() -> None:
    cache = filled([10, 1000], cache_time_ns=100)
    middle = cache.at(505)
    assert middle is not None
    assert middle[0][0] == pytest.approx(505.0)
    cache.insert(1001, (pose(), "parent"))
    assert cache.at(505) is None


@pytest.mark.parametrize("order", [1, -1])
def test_every_sample_reads_back_at_its_own_stamp(order: int) -> None:
    stamps = list(range(1, 51))[::order]
    cache = filled(stamps)
    for stamp in stamps:
        sample = cache.at(stamp)
        assert sample is not None
        assert sample[0][0] == stamp


def test_the_first_sample_can_be_stamped_zero() -> None:
    cache = filled([0, 5, 9])
    assert cache.oldest_stamp == 0
    newest = cache.at(0)
    assert newest is not None
    assert newest[0][0] == 9.0  # a zero in a question means the newest


def test_the_last_of_equal_newest_stamps_and_the_first_of_equal_oldest_are_read() -> None:
    cache = TimeCache(FAR)
    for stamp, x in ((1, 1.0), (1, 2.0), (5, 3.0), (5, 4.0), (9, 5.0), (9, 6.0)):
        cache.insert(stamp, (pose(x), "parent"))
    read = {}
    for stamp in (1, 5, 9):
        sample = cache.at(stamp)
        assert sample is not None
        read[stamp] = sample[0][0]
    assert read == {1: 1.0, 5: 4.0, 9: 6.0}


def test_translations_are_interpolated_on_a_straight_line() -> None:
    random.seed(3)
    for _ in range(100):
        ax, ay, az, bx, by, bz = (random.uniform(-10, 10) for _ in range(6))
        a, b = (ax, ay, az, 0.0, 0.0, 0.0, 1.0), (bx, by, bz, 0.0, 0.0, 0.0, 1.0)
        cache = TimeCache(FAR)
        cache.insert(100, (a, "parent"))
        cache.insert(200, (b, "parent"))
        for stamp in range(100, 201, 7):
            sample = cache.at(stamp)
            assert sample is not None
            ratio = (stamp - 100) / 100
            expected = [u + ratio * (v - u) for u, v in zip(a[:3], b[:3], strict=True)]
            assert sample[0][:3] == pytest.approx(expected, abs=1e-9)


def test_nothing_is_interpolated_across_a_change_of_parent() -> None:
    cache = TimeCache(FAR)
    cache.insert(100, (pose(1.0), "first"))
    cache.insert(200, (pose(2.0), "second"))
    assert cache.at(150) == (pose(1.0), "first")
    assert cache.at(200) == (pose(2.0), "second")


def test_rotations_are_interpolated_at_constant_speed_the_short_way_round() -> None:
    cache = TimeCache(FAR)
    cache.insert(100, (pose(yaw=0.2), "parent"))
    cache.insert(200, ((0.0, 0.0, 0.0, 0.0, 0.0, -math.sin(0.6), -math.cos(0.6)), "parent"))
    for stamp in range(100, 200, 10):
        sample = cache.at(stamp)
        assert sample is not None
        x, y, z, w = sample[0][3:]
        assert (x, y) == (0.0, 0.0)
        assert 2 * math.atan2(z, w) == pytest.approx(0.2 + (stamp - 100) / 100)


def test_interpolation_between_equal_rotations_returns_them_unchanged() -> None:
    a = pose(1.0, 0.7)
    assert interpolate(a, (3.0, *a[1:]), 0.5) == (2.0, *a[1:])


def test_an_empty_cache_has_no_data() -> None:
    cache = TimeCache(FAR)
    assert cache.at(0) is None
    assert cache.refusal(5) == (NoDataForExtrapolationException, "")
    assert (cache.newest_stamp, cache.oldest_stamp) == (0, 0)


def test_a_refusal_names_the_side_of_the_data_the_time_lies_on() -> None:
    single, several = filled([2_000_000_000]), filled([2_000_000_000, 3_500_000_000])
    assert single.at(1) is None
    assert single.refusal(1_000_000_000) == (
        NoDataForExtrapolationException,
        "Lookup would require extrapolation at time 1.000000, but only time 2.000000 is in the "
        "buffer",
    )
    assert several.refusal(1_000_000_000) == (
        BackwardExtrapolationException,
        "Lookup would require extrapolation into the past.  Requested time 1.000000 but the "
        "earliest data is at time 2.000000",
    )
    assert several.refusal(4_000_000_000) == (
        ForwardExtrapolationException,
        "Lookup would require extrapolation into the future.  Requested time 4.000000 but the "
        "latest data is at time 3.500000",
    )


def test_memory_is_bounded_even_when_the_clock_of_the_publisher_stands_still() -> None:
    cache = TimeCache(FAR)
    for stamp_ns in range(MAX_SAMPLES + 1):
        cache.insert(stamp_ns, (pose(), "parent"))
    assert len(cache) == MAX_SAMPLES
    assert cache.stamps[0] == 1


def test_a_static_cache_keeps_only_the_last_pose_and_has_no_time() -> None:
    cache = StaticCache()
    assert cache.insert(5, (pose(1.0), "parent"))
    assert cache.insert(3, (pose(2.0), "other"))
    assert cache.at(123) == (pose(2.0), "other")
    assert (len(cache), cache.newest_stamp, cache.oldest_stamp) == (1, 0, 0)
    cache.clear()
    assert cache.at(0) == (pose(2.0), "other")


def test_after_every_insert_samples_newer_than_the_last_mixed_one_have_one_parent() -> None:
    dice = random.Random(5)
    cache = TimeCache(20)
    newest = 0
    for step in range(2000):
        newest += dice.choice((0, 1, 1, 2))
        stamp = newest - dice.choice((0, 0, 0, 3, 25))
        pose = (dice.random(), 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
        cache.insert(stamp, (pose, dice.choice("aaaaaaaab")))
        if step % 500 == 499:
            cache.clear()
        assert len(cache.stamps) == len(cache.poses) == len(cache.parents)
        rows = zip(cache.stamps, cache.parents, strict=True)
        assert len({parent for stamp, parent in rows if stamp > cache.mixed_ns}) <= 1
