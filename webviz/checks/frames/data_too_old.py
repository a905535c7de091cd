"""Data that is older than the transforms."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class DataTooOld(Check):
    """Data older than the transforms.

    Data arrives so late that the transforms of its time are no longer kept, or it is older than the
    first of them.

    Why:
        tf2 keeps ten seconds. Data that is older comes through a slow node or network, or its stamp
        is wrong.

    Repair:
        Look for the node that delays the data, and compare its stamps with the clock.
    """

    id = "TF020"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for symptom, reason in observation.unplaced(Kind.BEHIND):
            yield self.found(
                f'Data in "{reason.frame}" is older than the transforms of "{reason.link}".',
                "Look for a slow node or network, and for wrong stamps.",
                subject=reason.link or reason.frame,
                severity=Severity.ERROR,
                evidence={"frame": reason.frame, "link": reason.link},
                explains=(symptom,),
            )
