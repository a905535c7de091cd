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

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such scan."""
        for display, found in seen.misfits():
            if found.fit.is_cured or found.is_placed:
                continue
            yield self.found(
                f"The scan of '{found.frame}' does not fit the map.",
                "Check that the map is of this place, and where the laser is mounted.",
                subject=display.display.name,
                proof=found.proof,
                evidence={"share": found.fit.share, "cured": found.fit.cured},
                explains=display.symptom("Map"),
            )
