"""Laser scans that are turned against the map."""

from __future__ import annotations

import math
from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, TryYaw
from webviz.api.observation import Observation


class ScanTurned(Check):
    """Scan is turned.

    A laser scan does not fit the map, and would fit if it were turned about the laser.

    Why:
        The yaw of the laser in the robot description is wrong, usually by 90° or 180°. Localisation
        and obstacle avoidance work with the wrong directions.

    Repair:
        Correct the yaw of the laser in the URDF, or in its static transform.
    """

    id = "DATA001"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such scan."""
        for display, found in seen.misfits():
            if found.fit.turn is None:
                continue
            yield self.found(
                f"The scan of '{found.frame}' is rotated by {-math.degrees(found.fit.turn):.0f}°.",
                f"Correct the yaw of '{found.frame}' in the robot description.",
                proof=found.proof,
                subject=display.display.name,
                evidence={"share": found.fit.share, "cured": found.fit.cured},
                explains=display.symptom("Map"),
                button=TryYaw(found.frame, found.fit.turn),
            )
