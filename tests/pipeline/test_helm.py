"""Who drives a vehicle, and how fast it should move."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from webviz.api.vehicle import STILL, Velocity
from webviz.engine.driving.helm import BEAT_S, PERIOD_S, RELEASE_S, TAIL, Helm
from webviz.engine.sources import Outlet
from webviz.tools.teleop import Teleop

AHEAD = Velocity(linear=1.0)
LIMITS = Velocity(0.5, 0.0, 1.0)


def make_helm(deceleration: float = 2.0) -> Helm:
    vehicle = Teleop(deceleration=deceleration).vehicle
    return Helm(vehicle, Outlet("/cmd_vel", "geometry_msgs/msg/Twist"))


def drive(helm: Helm, start: float, seconds: float, held: Velocity | None) -> list[Velocity | None]:
    """Return the commands published while a browser holds keys with heartbeats, or is silent."""
    steps = []
    for index in range(round(seconds / PERIOD_S)):
        now = start + index * PERIOD_S
        if held is not None:
            helm.steer(1, held, now, now)
        steps.append(helm.step(now))
    return steps


def test_a_drive_ramps_up_brakes_and_ends_with_some_zeros() -> None:
    helm = make_helm()
    assert helm.is_at_rest
    # 1 m/s² to 0.5 m/s, and 2 m/s² back: in steps of 0.05 s.
    up = [step.linear for step in drive(helm, 0.0, 0.6, AHEAD) if step]
    assert up == pytest.approx([*(0.05 * n for n in range(1, 11)), 0.5, 0.5])
    helm.steer(1, STILL, 0.6, 0.6)
    down = [step.linear for step in drive(helm, 0.6, 1.0, STILL) if step]
    assert down[:4] == pytest.approx([0.4, 0.3, 0.2, 0.1])
    assert down[-TAIL:] == [0.0] * TAIL
    assert len(down) <= 4 + 1 + TAIL  # one more where rounding leaves a rest
    assert helm.is_at_rest


def test_a_driver_who_falls_silent_stops_the_vehicle_at_once() -> None:
    helm = make_helm()
    drive(helm, 0.0, 1.0, AHEAD)
    steps = drive(helm, 1.0, 1.0, None)
    moving = [step for step in steps if step and step != STILL]
    assert len(moving) * PERIOD_S == pytest.approx(BEAT_S, abs=PERIOD_S)
    assert set(moving) == {Velocity(linear=0.5)}
    assert steps[len(moving) :] == [STILL] * TAIL + [None] * (len(steps) - len(moving) - TAIL)
    # A key that is still held counts again, from a standstill.
    helm.steer(1, AHEAD, 3.0, 3.0)
    assert helm.step(3.0) == Velocity(linear=0.05)


@pytest.mark.parametrize("held", [AHEAD, Velocity(linear=-0.5)], ids=["the same", "another"])
def test_a_driver_who_sends_but_receives_nothing_new_loses_control(held: Velocity) -> None:
    helm = make_helm()
    drive(helm, 0.0, 1.0, AHEAD)
    seen = 19 * PERIOD_S
    steps: list[Velocity | None] = []
    for now in (seen + 0.005 + 0.01 * index for index in range(60)):
        helm.steer(1, held, seen, now)
        steps.append(helm.step(now))
        assert now < seen + BEAT_S or steps[-1] in (STILL, None)
    assert steps[round(BEAT_S / 0.01) - 1] not in (STILL, None)
    assert steps.count(STILL) == TAIL
    # What it receives may take long, as long as it comes.
    for index in range(20):
        now = 2.0 + index * PERIOD_S
        helm.steer(1, AHEAD, now - 0.4, now)
        steps.append(helm.step(now))
    assert steps[-1] == Velocity(linear=0.5)


def test_what_was_received_before_counts_no_more() -> None:
    helm = make_helm()
    helm.steer(1, AHEAD, 1.0, 1.0)
    for index in range(1, 5):
        helm.steer(1, AHEAD, 1.0 - 0.1 * index, 1.0 + PERIOD_S * index)
    assert helm.deadline == 1.0 + BEAT_S


def test_another_driver_begins_with_what_the_first_had_not_received() -> None:
    helm = make_helm()
    drive(helm, 0.0, 1.0, AHEAD)
    drive(helm, 1.0, 2.0, None)
    helm.steer(2, AHEAD, 0.9, 3.0)
    assert helm.driver(3.0) == 2
    assert helm.step(3.0) == Velocity(linear=0.05)


def test_who_brakes_for_longer_than_the_release_keeps_control() -> None:
    helm = make_helm(deceleration=0.1)
    drive(helm, 0.0, 1.0, AHEAD)
    drive(helm, 1.0, 2.0, STILL)
    helm.steer(2, AHEAD, 3.0, 3.0)
    assert helm.driver(3.0) == 1
    assert helm.step(3.0) == pytest.approx((0.295, 0.0, 0.0))


@pytest.mark.parametrize("share", [math.inf, -math.inf, math.nan])
def test_a_set_point_that_is_not_finite_counts_as_zero(share: float) -> None:
    helm = make_helm()
    assert not helm.steer(1, Velocity(linear=share), 0.0, 0.0)
    assert helm.driver(0.0) is None
    assert helm.is_at_rest


def test_the_first_driver_keeps_control_until_a_second_after_letting_go() -> None:
    helm = make_helm()
    helm.steer(1, STILL, 0.0, 0.0)
    assert helm.driver(0.0) is None
    drive(helm, 0.0, 1.0, AHEAD)
    helm.steer(2, Velocity(linear=-1.0), 1.0, 1.0)
    assert helm.driver(1.0) == 1
    assert helm.step(1.0) == Velocity(linear=0.5)
    drive(helm, 1.05, 0.9, STILL)
    helm.steer(2, AHEAD, 1.9, 1.9)
    assert helm.is_at_rest
    helm.steer(2, AHEAD, 2.0, 1.0 + RELEASE_S)
    assert helm.driver(2.0) == 2
    helm.steer(1, AHEAD, 2.0, 2.0)
    helm.steer(1, STILL, 2.0, 2.0)
    assert helm.driver(2.0) == 2
    assert helm.step(2.0) == Velocity(linear=0.05)


numbers = st.floats() | st.sampled_from([0.0, 1.0, -1.0, 1e308, math.nan, math.inf, -math.inf])


@given(st.lists(st.tuples(st.tuples(numbers, numbers, numbers), st.floats(0.0, 0.4)), max_size=40))
def test_whatever_is_held_a_vehicle_keeps_its_limits_and_ramps(
    held: list[tuple[tuple[float, float, float], float]],
) -> None:
    helm, now = make_helm(), 0.0
    ramps = helm.vehicle.acceleration, helm.vehicle.deceleration
    velocities = [STILL]
    for share, wait in held:
        helm.steer(1, Velocity(*share), now, now)
        for _ in range(3):
            now += wait / 3
            velocities.append(helm.step(now) or STILL)
    for before, after in pairwise(velocities):
        for axis, limit in enumerate(LIMITS):
            assert abs(after[axis]) <= limit
            step = max(ramp[axis] for ramp in ramps) * PERIOD_S
            assert abs(after[axis] - before[axis]) <= step + 1e-9 or after == STILL
