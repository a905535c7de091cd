"""Rate of ROS time, for pages that count by themselves."""

from __future__ import annotations

import pytest

from webviz.engine.pipeline.clock_rate import ClockRateMeter, Rate
from webviz.engine.state import ClockRate

WALL = 1_700_000_000.0


def paces(rate: float, tick_s: float = 0.01) -> list[ClockRate]:
    """Return the rates a simulation yields in 10 s, given the ticks of its /clock."""
    meter = ClockRateMeter()
    results = []
    for i in range(50):
        ros_s = 100 + (i * 0.2 * rate) // tick_s * tick_s
        results.append(meter.step(round(ros_s * 1e9), WALL + i * 0.2))
    return results


@pytest.mark.parametrize("rate", [1.0, 0.5, 3.0])
def test_a_steady_clock_is_reported_once_its_rate_is_known(rate: float) -> None:
    result = paces(rate)
    assert len(set(result)) <= 4
    assert result[-1].rate == pytest.approx(rate, abs=0.1)
    assert abs(result[-1].at(WALL + 9.8) - round((100 + 9.8 * rate) * 1e9)) < 0.15e9


def test_steps_of_a_slow_clock_are_not_changes_of_rate() -> None:
    assert len(set(paces(1.0, tick_s=0.1))) <= 2


def test_a_rate_of_nearly_1_is_1_and_others_are_as_measured() -> None:
    assert paces(1.016)[-1].rate == 1.0
    assert paces(0.9)[-1].rate == pytest.approx(0.9, abs=0.02)


def test_a_time_that_jumps_back_goes_on_at_1_until_its_rate_is_known_again() -> None:
    meter = ClockRateMeter()
    for i in range(10):
        meter.step(round((100 + i * 0.2) * 1e9), WALL + i * 0.2)
    assert meter.step(round(50e9), WALL + 2.0) == ClockRate(round(50e9), WALL + 2.0, 1.0)


def test_a_paused_clock_and_its_continuation_are_reported() -> None:
    meter = ClockRateMeter()
    for i in range(10):
        meter.step(round((100 + i * 0.2) * 1e9), WALL + i * 0.2)
    still = [meter.step(round(101.8e9), WALL + 1.8 + i * 0.2) for i in range(10)]
    assert still[-1].rate == 0.0
    assert still[-1].ros_ns == round(101.8e9)
    moving = [meter.step(round((101.8 + i * 0.2) * 1e9), WALL + 3.8 + i * 0.2) for i in range(20)]
    assert moving[-1].rate == pytest.approx(1.0, abs=0.1)


def test_a_paused_time_stands_still_at_once() -> None:
    meter = ClockRateMeter()
    meter.step(100, WALL)
    assert meter.step(100, WALL + 0.001, is_paused=True).rate == 0.0


def test_a_rate_counts_the_last_seconds() -> None:
    rate = Rate()
    assert rate.step(0, 10.0) == 0.0
    results = [rate.step(20 * i, 10.0 + i * 0.2) for i in range(1, 50)]
    assert results[-1] == pytest.approx(100.0)
    assert rate.step(0, 20.0) == 0.0  # counted anew
