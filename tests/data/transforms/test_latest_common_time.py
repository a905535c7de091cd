"""The latest time common to a chain, as tf2 computes it, with its surprises."""

import pytest

from tests.data.transforms.conftest import HandFedBuffer
from webviz.data.transforms import (
    InvalidArgumentException,
    LookupException,
    NoDataForExtrapolationException,
)

S = 1_000_000_000
UNIT = (0.0, 0.0, 0.0, 1.0)
ZERO = (0.0, 0.0, 0.0)


def test_the_latest_common_time_is_the_oldest_of_the_newest_stamps(buffer: HandFedBuffer) -> None:
    for stamp in (0.0, 1.0, 0.5):
        buffer.put("map", "odom", stamp)
    assert buffer.latest_common_time("map", "odom") == S
    buffer.put("odom", "base", 0.7)
    assert buffer.latest_common_time("map", "base") == 700_000_000
    assert buffer.latest_common_time("base", "map") == 700_000_000
    buffer.put("base", "laser", is_static=True)
    buffer.put("map", "other", 0.2)
    assert buffer.latest_common_time("laser", "base") == 0
    assert buffer.latest_common_time("laser", "other") == 200_000_000


def test_the_latest_common_time_is_known_across_a_thousand_links(buffer: HandFedBuffer) -> None:
    buffer.put("map", "f0", 1.0)
    buffer.put("map", "other", 1.0)
    for number in range(999):
        buffer.put(f"f{number}", f"f{number + 1}", 1.0)
    for target, source in (("other", "f999"), ("f999", "other")):
        assert buffer.latest_common_time(target, source) == S


def test_links_above_the_common_ancestor_do_not_count_for_the_common_time(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("map", "base", 1.0)
    buffer.put("base", "left", 5.0)
    buffer.put("base", "right", 6.0)
    assert buffer.latest_common_time("left", "right") == 5 * S


def test_a_moving_transform_stamped_zero_does_not_count_for_the_common_time(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("map", "odom", 0.0, 1.0)
    assert buffer.latest_common_time("map", "odom") == 0
    assert buffer.lookup("map", "odom", 0).stamp_ns == 0
    buffer.put("odom", "base", 5.0, 1.0)
    assert buffer.latest_common_time("map", "base") == 5 * S
    with pytest.raises(NoDataForExtrapolationException):
        buffer.lookup("map", "base", 0)


def test_the_latest_fails_where_a_fast_link_has_one_sample_newer_than_the_slow_link(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("map", "odom", 1.0)
    buffer.put("odom", "base", 1.1)
    with pytest.raises(NoDataForExtrapolationException):
        buffer.lookup("map", "base", 0)
    buffer.put("odom", "base", 0.9)
    assert buffer.lookup("map", "base", 0).stamp_ns == S


@pytest.mark.parametrize(
    ("target", "source", "kind"),
    [("nowhere", "a", LookupException), ("a", "", InvalidArgumentException)],
)
def test_the_latest_common_time_validates_its_frames(
    buffer: HandFedBuffer, target: str, source: str, kind: type
) -> None:
    buffer.put("a", "b")
    with pytest.raises(kind, match="passed to get_latest_common_time"):
        buffer.latest_common_time(target, source)


def test_a_transform_stamped_zero_is_not_valid_later_but_a_static_one_is(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("map", "odom", 0.0)
    assert not buffer.can_transform("map", "odom", S // 2)
    buffer.put("map", "odom", 0.0, is_static=True)
    assert buffer.can_transform("map", "odom", S // 2)
    assert buffer.lookup("map", "odom", S // 2).stamp_ns == S // 2
