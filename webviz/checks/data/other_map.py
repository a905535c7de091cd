"""Laser scans that fit nowhere."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class OtherMap(Check):
    """Scan does not fit the map.

    A laser scan does not fit the map, and no turn or shift would make it fit.

    Why:
        It may be the map of another place, or the transform of the laser is wrong in more than one
        way.

    Repair:
        Check that the map is of this place, then the localisation, then the transform of the laser.
    """

    id = "DATA004"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such scan."""
        for display, misfit in observation.misfits():
            if misfit.fit.is_cured or misfit.is_placed:
                continue
            yield self.found(
                f"The scan of '{misfit.frame}' does not fit the map.",
                "Check that the map is of this place, and where the laser is mounted.",
                subject=display.display.name,
                proof=misfit.proof,
                evidence={"share": misfit.fit.share, "cured": misfit.fit.cured},
                explains=display.symptom("Map"),
            )
