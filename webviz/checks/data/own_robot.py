"""Scans of the robot itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

SCAN = "sensor_msgs/msg/LaserScan"
NEAR_M = 0.12
"""Few obstacles come that near to a laser within a robot."""
FEWEST = 4
MOST = 0.8
"""Share of beams; more of them are another fault."""
MOVED_M, MOVED = 0.2, 0.25
"""Change of a range, and share of the other beams with it, that show that the robot has moved."""
SAME = 0.8
"""Share of the near beams that stay near while the robot moves, if it is the robot itself."""


class _Sighting(msgspec.Struct, frozen=True):
    """A scan: ranges in metres, the beams that are near, and those that measure anything."""

    ranges: NDArray[np.float64]
    near: NDArray[np.bool_]
    valid: NDArray[np.bool_]


class SeesItself(Check):
    """Laser sees its own robot.

    Some beams of a laser scan end so near that only the robot itself can be there. It is a note
    until the robot has moved and the same beams are still near.

    Why:
        Cables, posts and covers in the plane of the laser are obstacles for the planner, which then
        does not move, and wrong walls for the mapping.

    Repair:
        Cut these angles, or raise `range_min` beyond them:

            ros2 param set /laser range_min 0.2
    """

    id = "DATA014"

    def __init__(self) -> None:
        self._first: dict[str, _Sighting] = {}
        """Scan with which the near beams were seen first, by topic."""

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic with near beams that stay near."""
        for _, each in observation.samples(SCAN):
            now = _sighting(each.message)
            near = int(now.near.sum())
            first = self._first.get(each.topic)
            if near < FEWEST or near > MOST * len(now.ranges):
                self._first.pop(each.topic, None)
                continue
            if first is None or len(first.ranges) != len(now.ranges):
                first = self._first[each.topic] = now
            has_moved = _has_moved(first, now)
            if has_moved and int((first.near & now.near).sum()) < SAME * near:
                self._first[each.topic] = now  # it was an obstacle
                continue
            yield self.found(
                f"{near} beams of {each.topic} end within {NEAR_M:g} m, "
                + ("at the robot itself." if has_moved else "perhaps at the robot itself."),
                "Cut these angles in a filter, or raise range_min.",
                subject=each.topic,
                severity=Severity.WARNING if has_moved else Severity.NOTE,
                evidence={"beams": near, "nearest_m": float(now.ranges[now.near].min())},
            )


def _sighting(scan: Any) -> _Sighting:
    ranges = np.asarray(scan.ranges, dtype=np.float64)
    valid = (ranges >= scan.range_min) & (ranges <= scan.range_max)
    return _Sighting(ranges, valid & (ranges < NEAR_M), valid)


def _has_moved(first: _Sighting, now: _Sighting) -> bool:
    """Return whether many of the beams that are not near measure something else."""
    both = first.valid & now.valid & ~first.near & ~now.near
    changed = np.abs(first.ranges - now.ranges)[both] > MOVED_M
    return int(changed.sum()) > MOVED * len(changed)
