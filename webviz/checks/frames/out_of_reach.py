"""Transforms that lead too far away."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class OutOfReach(Check):
    """Transform that leads too far away.

    A transform places a frame so far away that nothing can be drawn there.

    Why:
        Usually a value in UTM coordinates or in millimetres, or an estimate that has diverged.

    Repair:
        Correct the publisher of the longest transform on the way.
    """

    id = "TF022"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for symptom, reason in seen.lost(Kind.OUT_OF_REACH):
            yield self.found(
                f'The frame "{reason.frame}" is too far from "{seen.fixed_frame}" to be drawn.',
                "Correct the publisher of the transform.",
                subject=reason.link or reason.frame,
                severity=Severity.ERROR,
                evidence={"frame": reason.frame},
                explains=(symptom,),
            )
