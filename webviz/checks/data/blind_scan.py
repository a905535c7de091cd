"""Laser scans without a valid range."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.checks.data.millimetres import FARTHEST_M, middle_of

SCAN = "sensor_msgs/msg/LaserScan"


class BlindScan(Check):
    """Scan without valid ranges.

    No range of a laser scan is a number within its limits.

    Why:
        The laser is covered or has failed, or its limits are wrong. Localisation sees nothing.

    Repair:
        Clean the laser, and compare `range_min` and `range_max` with its data sheet.
    """

    id = "DATA006"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for display, each in observation.samples(SCAN):
            scan = each.message
            ranges = np.asarray(scan.ranges)
            if not len(ranges) or ((ranges >= scan.range_min) & (ranges <= scan.range_max)).any():
                continue
            if np.isposinf(ranges).all() or middle_of(ranges) > FARTHEST_M:
                continue  # it looks into the open, or has another unit
            yield self.found(
                f"No range on {each.topic} is between {scan.range_min:g} and {scan.range_max:g} m.",
                "Clean the laser, and check its limits in the driver.",
                subject=each.topic,
                evidence={"beams": len(ranges), "invalid": int(np.isnan(ranges).sum())},
                command=f"ros2 topic echo --once {each.topic}",
                explains=(*display.symptom("Points"), *display.symptom("Display")),
            )
