"""Odometry whose pose and twist contradict each other."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import msgspec

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

ODOMETRY = "nav_msgs/msg/Odometry"
LEAST_M, MIN_RAD = 0.05, 0.05
"""Movements between two rounds that show a direction."""
MAX_RAD = 2.0
"""Turn between two rounds whose direction is not ambiguous."""
LONGEST_S = 5.0
ROUNDS = 3
"""In a row in which the directions differ."""


class OdometrySign(Check):
    """Odometry with a wrong sign.

    The pose of an odometry moves against its own twist: forwards while it reports a speed
    backwards, or left while it reports a turn to the right.

    Why:
        A motor or an encoder is connected the wrong way round, or one of the two is computed with
        a wrong sign. Filters and controllers that use both become unstable.

    Repair:
        Drive straight on by hand: `twist.twist.linear.x` must be positive, and the pose must move
        along its own x axis. Then turn to the left: `twist.twist.angular.z` must be positive, and
        the yaw must grow.
    """

    id = "DATA013"

    def __init__(self) -> None:
        self._last: dict[str, _Motion] = {}
        self._wrong: dict[tuple[str, str], int] = {}

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic whose directions have differed for some rounds."""
        for _, each in seen.samples(ODOMETRY):
            now = _motion(each.message)
            before = self._last.get(each.topic)
            if before is None or now.at_s != before.at_s:
                self._last[each.topic] = now
                self._compare(each.topic, before, now)
            for axis in ("linear.x", "angular.z"):
                if self._wrong.get((each.topic, axis), 0) >= ROUNDS:
                    yield self.found(
                        f"The pose on {each.topic} moves against its own twist.twist.{axis}.",
                        "Correct the sign of the encoders, or in the code that computes the twist.",
                        subject=each.topic,
                        evidence={"topic": each.topic, "field": f"twist.twist.{axis}"},
                        command=f"ros2 topic echo --once --field twist.twist {each.topic}",
                    )

    def _compare(self, topic: str, before: _Motion | None, now: _Motion) -> None:
        if before is None or not 0.0 < now.at_s - before.at_s < LONGEST_S:
            return
        seconds, x, y = now.at_s - before.at_s, now.x - before.x, now.y - before.y
        ahead = x * math.cos(before.yaw) + y * math.sin(before.yaw)
        turned = math.remainder(now.yaw - before.yaw, math.tau)
        for axis, moved, speeds, least, most in (
            ("linear.x", ahead, (before.speed, now.speed), LEAST_M, math.inf),
            ("angular.z", turned, (before.turn, now.turn), MIN_RAD, MAX_RAD),
        ):
            told = sum(speeds) / 2 * seconds
            is_steady = speeds[0] * speeds[1] > 0.0
            if is_steady and abs(moved) >= least and least <= abs(told) <= most:
                key = topic, axis
                self._wrong[key] = self._wrong.get(key, 0) + 1 if moved * told < 0.0 else 0


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
    q = pose.orientation
    yaw = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
    return _Motion(
        at_s=stamp.sec + stamp.nanosec / 1e9,
        x=pose.position.x,
        y=pose.position.y,
        yaw=yaw,
        speed=twist.linear.x,
        turn=twist.angular.z,
    )
