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

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such scan."""
        for display, misfit in observation.misfits():
            if misfit.fit.turn is None:
                continue
            yield self.found(
                f"The scan of '{misfit.frame}' is rotated by "
                f"{-math.degrees(misfit.fit.turn):.0f}°.",
                f"Correct the yaw of '{misfit.frame}' in the robot description.",
                proof=misfit.proof,
                subject=display.display.name,
                evidence={"share": misfit.fit.share, "cured": misfit.fit.cured},
                explains=display.symptom("Map"),
                button=TryYaw(misfit.frame, misfit.fit.turn),
            )
