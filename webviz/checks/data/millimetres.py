"""Ranges in millimetres."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

SCAN = "sensor_msgs/msg/LaserScan"
FARTHEST_M = 200.0
"""Distance in metres beyond the reach of any planar laser."""


class Millimetres(Check):
    """Ranges in millimetres.

    The ranges of a laser scan are so large that they must be millimetres.

    Why:
        ROS uses metres. Everything is a thousand times as far away, outside of the view and of
        every costmap.

    Repair:
        Divide the ranges by 1000 in the driver.
    """

    id = "DATA007"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for display, each in observation.samples(SCAN):
            middle = middle_of(np.asarray(each.message.ranges))
            if middle > FARTHEST_M:
                yield self.found(
                    f"The ranges on {each.topic} are millimetres: half of them are above "
                    f"{middle:.0f} m.",
                    "Publish metres.",
                    subject=each.topic,
                    evidence={"median_m": middle},
                    command=f"ros2 topic echo --once {each.topic}",
                    explains=(*display.symptom("Points"), *display.symptom("Map")),
                )


def middle_of(ranges: NDArray[Any]) -> float:
    """Return the median of the ranges that are positive numbers, 0 without any."""
    # `np.median` imports numpy.ma, 8 ms of the frame loop.
    ranges = np.sort(ranges[np.isfinite(ranges) & (ranges > 0.0)])
    return float(ranges[len(ranges) // 2]) if len(ranges) else 0.0
