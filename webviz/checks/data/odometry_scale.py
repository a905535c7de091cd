"""Odometry whose twist has another unit than its pose."""

from __future__ import annotations

import math
from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.checks.data.motion import Motions

ROUNDS = 4
"""Number of rounds of steady motion in which the speeds have the same ratio."""
ALIKE = 0.2
"""Relative difference between ratios that are the same."""
APART = 2.5
"""Ratio of two speeds that slipping wheels do not explain."""
UNITS = {
    "linear.x": (("km/h", 3.6), ("mm/s", 1000.0)),
    "angular.z": (("degrees per second", math.degrees(1.0)),),
}
NEAR = 0.15
"""Relative difference from a factor up to which it explains the ratio."""
SI = {"linear.x": "m/s", "angular.z": "rad/s"}


class OdometryScale(Check):
    """Odometry with a wrong scale.

    The pose of an odometry moves at another speed than its own twist says, several times as fast or
    as slowly.

    Why:
        The twist is in degrees or km/h instead of rad/s and m/s, or the two are computed with
        different wheels or gears. Filters that use the twist turn or drive too far.

    Repair:
        Drive a known distance, and compare both with it:

            ros2 topic echo --field twist.twist /odom
    """

    id = "DATA020"

    def __init__(self) -> None:
        self._motions = Motions()
        self._ratios: dict[tuple[str, str], list[float]] = {}
        """Ratios of the twist to the pose in the last rounds of steady motion, by topic and
        axis."""

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic and axis whose speeds have one ratio for some rounds."""
        for moved in self._motions.since(observation):
            if moved.is_steady:
                ratios = self._ratios.setdefault((moved.topic, moved.axis), [])
                ratios.append(moved.by_twist / moved.by_pose)
                del ratios[:-ROUNDS]
        for (topic, axis), ratios in self._ratios.items():
            ratio = sorted(ratios)[len(ratios) // 2]
            if len(ratios) < ROUNDS or 1.0 / APART < ratio < APART or ratio <= 0.0:
                continue
            if any(abs(each / ratio - 1.0) > ALIKE for each in ratios):
                continue  # not a matter of units
            unit = next((u for u, by in UNITS[axis] if abs(ratio / by - 1.0) < NEAR), "")
            yield self.found(
                f"twist.twist.{axis} on {topic} is {ratio:.2g} times as fast as its pose moves"
                + (f", as if it were in {unit}." if unit else "."),
                f"Publish the twist in {SI[axis]}, and compare it with a known distance.",
                subject=topic,
                evidence={"topic": topic, "field": f"twist.twist.{axis}", "ratio": round(ratio, 3)},
                command=f"ros2 topic echo --once --field twist.twist {topic}",
            )
