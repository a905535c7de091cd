"""Odometry whose pose and twist contradict each other."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.checks.data.motion import LEAST_M, MIN_RAD, Motions, Streaks

ROUNDS = 3
"""Number of rounds in a row in which the directions differ."""


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
        self._motions, self._wrong = Motions(), Streaks()

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic whose directions have differed for some rounds."""
        for moved in self._motions.since(observation):
            if abs(moved.by_twist) >= (LEAST_M if moved.axis == "linear.x" else MIN_RAD):
                self._wrong.note(moved, moved.by_pose * moved.by_twist < 0.0)
        for topic, axis in self._wrong.lasting(ROUNDS):
            yield self.found(
                f"The pose on {topic} moves against its own twist.twist.{axis}.",
                "Correct the sign of the encoders, or in the code that computes the twist.",
                subject=topic,
                evidence={"topic": topic, "field": f"twist.twist.{axis}"},
                command=f"ros2 topic echo --once --field twist.twist {topic}",
            )
