"""Movements that odometry reports between two rounds of checks, by its pose and by its twist."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import msgspec

from webviz.api.observation import Observation

ODOMETRY = "nav_msgs/msg/Odometry"
LEAST_M, MIN_RAD = 0.05, 0.05
"""Movements between two rounds that show a direction."""
MAX_RAD = 2.0
"""Turn between two rounds whose direction is not ambiguous."""
LONGEST_S = 5.0
STEADY = 0.2
"""Relative difference of two speeds that are nearly equal."""


class Moved(NamedTuple):
    """The way along an axis in m, or the turn about it in rad.

    Args:
        topic: of the odometry.
        axis: field of the twist, such as "linear.x".
        by_pose: according to two poses.
        by_twist: according to the twist at both, of which the signs are equal.
        is_steady: whether both speeds are nearly equal, so that `by_twist` is not far from the way.
    """

    topic: str
    axis: str
    by_pose: float
    by_twist: float
    is_steady: bool


class Motions:
    """Remembers the odometry of the round before."""

    def __init__(self) -> None:
        self._last: dict[str, _Motion] = {}

    def since(self, observation: Observation) -> Iterator[Moved]:
        """Yield the movements since the round before that are large enough to be compared."""
        for _, each in observation.samples(ODOMETRY):
            now, before = _motion(each.message), self._last.get(each.topic)
            if before is None or now.at_s != before.at_s:
                self._last[each.topic] = now
                if before is not None and 0.0 < now.at_s - before.at_s < LONGEST_S:
                    yield from _moved(each.topic, before, now)


def _moved(topic: str, before: _Motion, now: _Motion) -> Iterator[Moved]:
    seconds, x, y = now.at_s - before.at_s, now.x - before.x, now.y - before.y
    turned = math.remainder(now.yaw - before.yaw, math.tau)
    # The chord of the arc that a robot drives, along the direction half-way.
    way = before.yaw + turned / 2
    ahead = x * math.cos(way) + y * math.sin(way)
    for axis, moved, speeds, least, most in (
        ("linear.x", ahead, (before.speed, now.speed), LEAST_M, math.inf),
        ("angular.z", turned, (before.turn, now.turn), MIN_RAD, MAX_RAD),
    ):
        if speeds[0] * speeds[1] > 0.0 and least <= abs(moved) <= most:
            is_steady = abs(speeds[0] - speeds[1]) <= STEADY * max(map(abs, speeds))
            yield Moved(topic, axis, moved, sum(speeds) / 2 * seconds, is_steady)


class Streaks:
    """Counts in how many rounds in a row something was so, by topic and axis."""

    def __init__(self) -> None:
        self._counts: dict[tuple[str, str], int] = {}

    def note(self, moved: Moved, is_so: bool) -> None:
        """Take a round."""
        key = moved.topic, moved.axis
        self._counts[key] = self._counts.get(key, 0) + 1 if is_so else 0

    def lasting(self, rounds: int) -> Iterator[tuple[str, str]]:
        """Yield topics and axes of which it was so in as many rounds."""
        for key, count in self._counts.items():
            if count >= rounds:
                yield key


class _Motion(msgspec.Struct, frozen=True):
    """Pose and twist of an odometry in s, m, rad, m/s and rad/s."""

    at_s: float
    x: float
    y: float
    yaw: float
    speed: float
    turn: float


def _motion(odometry: Any) -> _Motion:
    stamp, pose, twist = odometry.header.stamp, odometry.pose.pose, odometry.twist.twist
    return _Motion(
        at_s=stamp.sec + stamp.nanosec / 1e9,
        x=pose.position.x,
        y=pose.position.y,
        yaw=yaw_of(pose.orientation),
        speed=twist.linear.x,
        turn=twist.angular.z,
    )


def yaw_of(q: Any) -> float:
    """Return the yaw of a geometry_msgs/Quaternion in rad."""
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
