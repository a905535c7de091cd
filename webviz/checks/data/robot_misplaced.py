"""Robots at the wrong place in the map."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class RobotMisplaced(Check):
    """Robot is misplaced.

    A laser scan does not fit the map, and would fit if the robot were elsewhere.

    Why:
        Localisation has a wrong idea of where the robot is, so that it plans through walls.

    Repair:
        Give AMCL the pose of the robot with the tool 2D Pose Estimate.
    """

    id = "DATA003"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such scan."""
        for display, found in seen.misfits():
            if found.fit.shift is None:
                continue
            yield self.found(
                f"The scan of '{found.frame}' is not at the walls: the robot is misplaced.",
                f"Correct the transform of '{found.frame}'."
                if found.is_placed
                else "Give the pose of the robot with the tool 2D Pose Estimate.",
                subject=display.display.name,
                evidence={"share": found.fit.share, "cured": found.fit.cured},
                explains=display.symptom("Map"),
            )
