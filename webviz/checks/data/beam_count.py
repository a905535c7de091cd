"""Laser scans whose angles and ranges disagree."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

SCAN = "sensor_msgs/msg/LaserScan"


class BeamCount(Check):
    """Angles and ranges disagree.

    A laser scan has another number of ranges than its angles call for.

    Why:
        The scan is drawn as a fan of the wrong width: walls are bent or turned.

    Repair:
        Correct `angle_min`, `angle_max` or `angle_increment` in the driver.
    """

    id = "DATA008"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for _, each in observation.samples(SCAN):
            scan, count = each.message, len(each.message.ranges)
            if not count or not scan.angle_increment:
                continue
            expected = (scan.angle_max - scan.angle_min) / scan.angle_increment + 1.0
            if abs(expected - count) > max(2.0, 0.02 * count):
                yield self.found(
                    f"{each.topic} has {count} ranges, but angles for {expected:.0f}.",
                    "Correct the angles in the driver of the laser.",
                    subject=each.topic,
                    evidence={"ranges": count, "expected": round(expected, 1)},
                    command=f"ros2 topic echo --once {each.topic}",
                )
