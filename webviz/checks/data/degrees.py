"""Laser scans whose angles are degrees."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import CauseLevel, Finding, Severity
from webviz.api.observation import Observation

SCAN = "sensor_msgs/msg/LaserScan"
WIDEST_RAD = 8.0
"""More than a turn by any driver that counts its first beam twice."""


class Degrees(Check):
    """Angles in degrees.

    The angles of a laser scan span more than a full turn.

    Why:
        ROS uses radians. Taken for these, the beams of a scan in degrees go round and round, so
        that walls become a cloud of points around the laser.

    Repair:
        Convert `angle_min`, `angle_max` and `angle_increment` to radians in the driver.
    """

    id = "DATA016"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for display, each in observation.samples(SCAN):
            scan = each.message
            span = abs(scan.angle_increment) * len(scan.ranges)
            if span > WIDEST_RAD:
                yield self.found(
                    f"The angles on {each.topic} span {span:.0f} rad, more than a full turn: they "
                    "are probably degrees.",
                    "Publish angle_min, angle_max and angle_increment in radians.",
                    subject=each.topic,
                    severity=Severity.ERROR,
                    evidence={"span_rad": round(span, 2), "increment": float(scan.angle_increment)},
                    command=f"ros2 topic echo --once --field angle_increment {each.topic}",
                    explains=(*display.symptom("Map"), *display.symptom("Display")),
                    causes=CauseLevel.DATA,  # a scan like that fits no map
                )
