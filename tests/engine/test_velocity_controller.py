"""Drivers of a vehicle, and how fast it should move."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from webviz.api.vehicle import STILL, Velocity
from webviz.engine.driving.velocity_controller import (
    BEAT_S,
    PERIOD_S,
    RELEASE_S,
    TAIL,
    VelocityController,
)
from webviz.sources import Advertisement
from webviz.tools.teleop import Teleop

AHEAD = Velocity(linear=1.0)
LIMITS = Velocity(0.5, 0.0, 1.0)


def make_controller(deceleration: float = 2.0, holding: int | None = None) -> VelocityController:
    vehicle = Teleop(deceleration=deceleration).vehicle
    return VelocityController(
        vehicle, Advertisement("/cmd_vel", "geometry_msgs/msg/Twist"), holding
    )


def drive(
    controller: VelocityController, start: float, seconds: float, share: Velocity | None
) -> list[Velocity | None]:
    """Return the commands published while a browser holds keys with heartbeats, or is silent."""
    steps = []
    for index in range(round(seconds / PERIOD_S)):
        now = start + index * PERIOD_S
        if share is not None:
            controller.steer(1, share, now, now)
        steps.append(controller.step(now))
    return steps


@pytest.mark.parametrize("way", [1.0, -1.0], ids=["ahead", "back"])
def test_a_drive_ramps_up_brakes_and_ends_with_some_zeros(way: float) -> None:
    controller = make_controller()
    assert controller.is_at_rest
    # 1 m/s² to 0.5 m/s, and 2 m/s² back: in steps of 0.05 s.
    up = [way * step.linear for step in drive(controller, 0.0, 0.6, Velocity(way)) if step]
    assert up == pytest.approx([*(0.05 * n for n in range(1, 11)), 0.5, 0.5])
    controller.steer(1, STILL, 0.6, 0.6)
    down = [way * step.linear for step in drive(controller, 0.6, 1.0, STILL) if step]
    assert down[:4] == pytest.approx([0.4, 0.3, 0.2, 0.1])
    assert down[-TAIL:] == [0.0] * TAIL
    assert len(down) <= 4 + 1 + TAIL  # one more where rounding leaves a rest
    assert controller.is_at_rest


def test_a_drive_that_ends_within_one_step_ends_with_some_zeros() -> None:
    controller = make_controller(deceleration=10.0)
    drive(controller, 0.0, 1.0, Velocity(linear=0.5))
    steps = drive(controller, 1.0, 1.0, STILL)
    assert steps == [STILL] * TAIL + [None] * (len(steps) - TAIL)


@pytest.mark.parametrize("way", [1.0, -1.0], ids=["ahead", "back"])
def test_slowing_down_brakes_and_reversing_passes_through_zero(way: float) -> None:
    controller = make_controller()
    drive(controller, 0.0, 1.0, Velocity(way))

    def speeds(start: float, share: float) -> list[float]:
        steps = drive(controller, start, 0.25, Velocity(share * way))
        return [way * step.linear for step in steps if step]

    assert speeds(1.0, 0.5) == pytest.approx([0.4, 0.3, 0.25, 0.25, 0.25])
    assert speeds(1.25, -1.0) == pytest.approx([0.15, 0.05, 0.0, -0.05, -0.1])
    assert speeds(1.5, 0.05) == pytest.approx([0.0, 0.025, 0.025, 0.025, 0.025])
    assert speeds(1.75, -0.04) == pytest.approx([0.0, -0.02, -0.02, -0.02, -0.02])


@pytest.mark.parametrize("way", [1.0, -1.0], ids=["ahead", "back"])
def test_a_driver_silent_before_the_first_command_moves_nothing(way: float) -> None:
    controller = make_controller()
    controller.steer(1, Velocity(way), 0.0, 0.0)
    assert [controller.step(BEAT_S + 0.05 * n) for n in range(TAIL + 1)] == [STILL] * TAIL + [None]


def test_an_axis_that_is_off_has_no_negative_zero() -> None:
    steps = drive(make_controller(), 0.0, 0.2, Velocity(1.0, -1.0, -0.0))
    assert {math.copysign(1.0, value) for step in steps if step for value in step} == {1.0}


def test_only_another_set_point_asks_for_a_command_before_its_time() -> None:
    controller = make_controller()
    shares = (1.0, 1.0, 0.5, 0.5, 1.0, 0.0, 0.0)
    asks = [controller.steer(1, Velocity(share), 0.0, 0.01 * n) for n, share in enumerate(shares)]
    assert asks == [True, False, True, False, True, True, False]


def test_halting_at_rest_publishes_nothing() -> None:
    controller = make_controller()
    controller.halt()
    assert controller.is_at_rest
    assert controller.step(0.0) is None


@pytest.mark.parametrize("way", [1.0, -1.0], ids=["ahead", "back"])
def test_a_silent_driver_stops_the_vehicle_at_once(way: float) -> None:
    controller = make_controller()
    drive(controller, 0.0, 1.0, Velocity(way))
    steps = drive(controller, 1.0, 1.0, None)
    moving = [step for step in steps if step and step != STILL]
    assert len(moving) * PERIOD_S == pytest.approx(BEAT_S, abs=PERIOD_S)
    assert set(moving) == {Velocity(0.5 * way)}
    assert steps[len(moving) :] == [STILL] * TAIL + [None] * (len(steps) - len(moving) - TAIL)
    # A key that is still held counts again, from a standstill.
    controller.steer(1, AHEAD, 3.0, 3.0)
    assert controller.step(3.0) == Velocity(linear=0.05)


@pytest.mark.parametrize("share", [AHEAD, Velocity(linear=-0.5)], ids=["the same", "another"])
def test_a_driver_who_sends_but_receives_nothing_new_loses_control(share: Velocity) -> None:
    controller = make_controller()
    drive(controller, 0.0, 1.0, AHEAD)
    beat_s = 19 * PERIOD_S
    steps: list[Velocity | None] = []
    for now in (beat_s + 0.005 + 0.01 * index for index in range(60)):
        is_new = controller.steer(1, share, beat_s, now)
        assert not is_new or now < beat_s + BEAT_S
        steps.append(controller.step(now))
        assert now < beat_s + BEAT_S or steps[-1] in (STILL, None)
    assert steps[round(BEAT_S / 0.01) - 1] not in (STILL, None)
    assert steps.count(STILL) == TAIL
    # What it receives may take long, as long as it comes.
    for index in range(20):
        now = 2.0 + index * PERIOD_S
        controller.steer(1, AHEAD, now - 0.4, now)
        steps.append(controller.step(now))
    assert steps[-1] == Velocity(linear=0.5)


def test_older_receptions_do_not_extend_the_deadline() -> None:
    controller = make_controller()
    controller.steer(1, AHEAD, 1.0, 1.0)
    for index in range(1, 5):
        controller.steer(1, AHEAD, 1.0 - 0.1 * index, 1.0 + PERIOD_S * index)
    assert controller.deadline == 1.0 + BEAT_S


def test_a_second_driver_is_not_bound_by_the_receptions_of_the_first() -> None:
    controller = make_controller()
    drive(controller, 0.0, 1.0, AHEAD)
    drive(controller, 1.0, 2.0, None)
    controller.steer(2, AHEAD, 0.9, 3.0)
    assert controller.driver(3.0) == 2
    assert controller.step(3.0) == Velocity(linear=0.05)


@pytest.mark.parametrize("way", [1.0, -1.0], ids=["ahead", "back"])
def test_a_driver_keeps_control_while_braking_longer_than_the_release(way: float) -> None:
    controller = make_controller(deceleration=0.1)
    drive(controller, 0.0, 1.0, Velocity(way))
    drive(controller, 1.0, 2.0, STILL)
    controller.steer(2, AHEAD, 3.0, 3.0)
    assert controller.driver(3.0) == 1
    assert controller.step(3.0) == pytest.approx((0.295 * way, 0.0, 0.0))


def test_a_browser_that_only_looks_takes_no_beats_from_the_next_driver() -> None:
    controller = make_controller()
    drive(controller, 0.0, 1.0, AHEAD)
    drive(controller, 1.0, 2.0, STILL)
    controller.steer(2, STILL, 5.0, 5.0)
    controller.steer(1, AHEAD, 4.8, 5.3)  # on a slower link
    assert controller.driver(5.3) == 1
    assert controller.step(5.3) == Velocity(linear=0.05)


def test_a_key_held_while_the_vehicle_changes_must_be_released_first() -> None:
    controller = make_controller(holding=1)
    for now in (0.0, 0.05):
        assert not controller.steer(1, AHEAD, now, now)
    assert controller.is_at_rest
    assert controller.driver(0.05) is None
    assert not controller.steer(1, STILL, 0.1, 0.1)
    assert controller.steer(1, AHEAD, 0.15, 0.15)
    assert make_controller(holding=1).steer(2, AHEAD, 0.0, 0.0)


@pytest.mark.parametrize("share", [math.inf, -math.inf, math.nan])
def test_a_set_point_that_is_not_finite_counts_as_zero(share: float) -> None:
    controller = make_controller()
    assert not controller.steer(1, Velocity(linear=share), 0.0, 0.0)
    assert controller.driver(0.0) is None
    assert controller.is_at_rest


@pytest.mark.parametrize("share", [1.5, -1.5, 1e308])
def test_a_set_point_beyond_a_limit_counts_as_the_limit(share: float) -> None:
    steps = drive(make_controller(), 0.0, 1.0, Velocity(linear=share))
    assert steps[-1] == Velocity(linear=math.copysign(LIMITS.linear, share))


def test_the_first_driver_keeps_control_until_a_second_after_letting_go() -> None:
    controller = make_controller()
    controller.steer(1, STILL, 0.0, 0.0)
    assert controller.driver(0.0) is None
    drive(controller, 0.0, 1.0, AHEAD)
    assert not controller.steer(2, Velocity(linear=-1.0), 1.0, 1.0)
    assert controller.driver(1.0) == 1
    assert controller.step(1.0) == Velocity(linear=0.5)
    drive(controller, 1.05, 0.9, STILL)
    controller.steer(2, AHEAD, 1.9, 1.9)
    assert controller.is_at_rest
    controller.steer(2, AHEAD, 2.0, 1.0 + RELEASE_S)
    assert controller.driver(2.0) == 2
    controller.steer(1, AHEAD, 2.0, 2.0)
    controller.steer(1, STILL, 2.0, 2.0)
    assert controller.driver(2.0) == 2
    assert controller.step(2.0) == Velocity(linear=0.05)


numbers = st.floats() | st.sampled_from([0.0, 1.0, -1.0, 1e308, math.nan, math.inf, -math.inf])


@given(st.lists(st.tuples(st.tuples(numbers, numbers, numbers), st.floats(0.0, 0.4)), max_size=40))
def test_a_vehicle_keeps_its_limits_and_ramps_for_any_input(
    inputs: list[tuple[tuple[float, float, float], float]],
) -> None:
    controller, now = make_controller(), 0.0
    ramps = controller.vehicle.acceleration, controller.vehicle.deceleration
    velocities = [STILL]
    for share, wait in inputs:
        controller.steer(1, Velocity(*share), now, now)
        for _ in range(3):
            now += wait / 3
            velocities.append(controller.step(now) or STILL)
    for before, after in pairwise(velocities):
        for axis, limit in enumerate(LIMITS):
            assert abs(after[axis]) <= limit
            step = max(ramp[axis] for ramp in ramps) * PERIOD_S
            assert abs(after[axis] - before[axis]) <= step + 1e-9 or after == STILL
