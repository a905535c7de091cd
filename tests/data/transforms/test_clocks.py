"""Clocks of publishers that disagree with ours, told in a sentence with the offset."""

import pytest

from webviz.data.transforms import TransformBuffer
from webviz.data.transforms.clocks import clock_problem

S = 1_000_000_000
NOW = 1_700_000_000 * S


def hear(buffer: TransformBuffer, child: str, offset_s: float, received_ns: int = NOW) -> None:
    """Transforms whose publisher's clock is ahead of ours by an offset."""
    hear_once(buffer, child, offset_s, max(0, received_ns - S // 20))
    hear_once(buffer, child, offset_s, received_ns)


def hear_once(buffer: TransformBuffer, child: str, offset_s: float, received_ns: int) -> None:
    stamp_ns = received_ns + round(offset_s * S)
    identity = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
    buffer.set_transform("map", child, stamp_ns, *identity, received_ns=received_ns)


@pytest.mark.parametrize("offset_s", [-1.0, -0.03, 0.0, 1.0])
def test_usual_delays_and_the_tolerance_of_amcl_are_accepted(
    buffer: TransformBuffer, offset_s: float
) -> None:
    hear(buffer, "odom", offset_s)
    assert clock_problem(buffer, NOW) is None


@pytest.mark.parametrize(("offset_s", "words"), [(2.0, "ahead of"), (-2.0, "behind")])
def test_one_machine_that_is_off_is_named_with_its_offset(
    buffer: TransformBuffer, offset_s: float, words: str
) -> None:
    hear(buffer, "odom", -0.01)
    hear(buffer, "camera", offset_s)
    assert str(clock_problem(buffer, NOW)) == (
        f'The transforms of "camera" are stamped 2.0 s {words} the clock of this computer, the '
        "others are not. Synchronise the clocks of the machines (chrony, NTP)."
    )


def test_if_all_are_off_no_frame_is_blamed(buffer: TransformBuffer) -> None:
    for child in ("odom", "camera"):
        hear(buffer, child, 3.0)
    assert str(clock_problem(buffer, NOW)).startswith("All transforms are stamped 3.0 s ahead of")


def test_a_replayed_bag_comes_with_the_way_to_follow_its_time(buffer: TransformBuffer) -> None:
    hear(buffer, "odom", -3 * 86400.0)
    sentence = str(clock_problem(buffer, NOW))
    assert "stamped 3 days behind the time of this computer" in sentence
    assert "use_sim_time:=true" in sentence


def test_simulated_time_is_recognised_and_not_counted_in_years(buffer: TransformBuffer) -> None:
    hear(buffer, "odom", 12.5 - NOW / S)
    assert str(clock_problem(buffer, NOW)) == (
        '"odom" is stamped with simulated time (12.5 s), but webviz follows the clock of this '
        "computer. Start webviz with --ros-args -p use_sim_time:=true."
    )


def test_simulated_time_may_be_behind_simulated_time(buffer: TransformBuffer) -> None:
    hear(buffer, "odom", -4000.0, 5000 * S)
    assert "stamped 67 min behind the time of this computer" in str(clock_problem(buffer, 5000 * S))


def test_a_silent_publisher_has_no_clock_problem(buffer: TransformBuffer) -> None:
    hear(buffer, "odom", 2.0)
    assert clock_problem(buffer, NOW + 5 * S)
    assert clock_problem(buffer, NOW + 11 * S) is None


def test_a_single_transform_is_not_judged(buffer: TransformBuffer) -> None:
    """Slices of recordings begin with the last one of each frame that has ended."""
    hear(buffer, "odom", 0.0)
    hear_once(buffer, "arm", -40.0, NOW)
    assert clock_problem(buffer, NOW) is None


def test_without_a_time_there_is_no_clock_problem(buffer: TransformBuffer) -> None:
    hear(buffer, "odom", 2.0, received_ns=0)
    assert clock_problem(buffer, 0) is None


def test_a_bag_comes_without_options_that_it_does_not_have(buffer: TransformBuffer) -> None:
    hear(buffer, "odom", -3 * 86400.0)
    assert str(clock_problem(buffer, NOW, is_recorded=True)) == (
        '"odom" is stamped 3 days behind the time of the bag. Synchronise the clocks of the '
        "machines before you record again."
    )
