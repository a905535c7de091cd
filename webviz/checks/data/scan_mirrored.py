"""Laser scans that are mirrored."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class ScanMirrored(Check):
    """Scan is mirrored.

    A laser scan does not fit the map, and would fit if it were mirrored.

    Why:
        The laser is mounted upside down, and its transform does not say so: left and right are
        exchanged.

    Repair:
        Give the laser a roll of 180° in the URDF, or set the driver to inverted mounting.
    """

    id = "DATA002"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such scan."""
        for display, misfit in observation.misfits():
            if not misfit.fit.is_mirrored:
                continue
            yield self.found(
                f"The scan of '{misfit.frame}' is mirrored against the map.",
                f"Give '{misfit.frame}' a roll of 180° in the robot description.",
                subject=display.display.name,
                proof=misfit.proof,
                evidence={"share": misfit.fit.share, "cured": misfit.fit.cured},
                explains=display.symptom("Map"),
            )
