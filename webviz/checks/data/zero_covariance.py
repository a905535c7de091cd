"""Poses that claim to be exact."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

TYPES = ("nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseWithCovarianceStamped")


class ZeroCovariance(Check):
    """Covariance of zero.

    All values of the covariance of a pose or an odometry are zero.

    Why:
        A filter such as robot_localization takes the pose for exact and ignores every other sensor;
        many drivers simply leave the covariance empty.

    Repair:
        Set realistic variances in the publisher.
    """

    id = "DATA010"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for _, each in observation.samples(*TYPES):
            pose = each.message.pose
            if not any(pose.covariance):
                yield self.found(
                    f"The covariance on {each.topic} is zero, as if its pose were exact.",
                    "Set realistic variances in its publisher.",
                    subject=each.topic,
                    severity=Severity.NOTE,
                    evidence={"topic": each.topic},
                    command=f"ros2 topic echo --once --field pose.covariance {each.topic}",
                )
