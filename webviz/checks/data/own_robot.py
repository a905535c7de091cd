"""Scans of the robot itself."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

SCAN = "sensor_msgs/msg/LaserScan"
NEAR_M = 0.12
"""No wall is that near to a laser within a robot."""
FEWEST = 4
MOST = 0.8
"""Share of beams; more of them are another fault."""


class SeesItself(Check):
    """Laser sees its own robot.

    Some beams of a laser scan end so near that only the robot itself can be there.

    Why:
        Cables, posts and covers in the plane of the laser are obstacles for the planner, which then
        does not move, and wrong walls for the mapping.

    Repair:
        Cut these angles, or raise `range_min` beyond them:

            ros2 param set /laser range_min 0.2
    """

    id = "DATA014"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for _, each in seen.samples(SCAN):
            scan = each.message
            ranges = np.asarray(scan.ranges, dtype=np.float64)
            valid = (ranges >= scan.range_min) & (ranges <= scan.range_max)
            near = int((valid & (ranges < NEAR_M)).sum())
            if near < FEWEST or near > MOST * len(ranges):
                continue
            nearest_m = float(ranges[valid].min())
            yield self.found(
                f"{near} beams of {each.topic} end within {NEAR_M:g} m, at the robot itself.",
                "Cut these angles in a filter, or raise range_min.",
                subject=each.topic,
                evidence={"beams": near, "nearest_m": nearest_m},
            )
