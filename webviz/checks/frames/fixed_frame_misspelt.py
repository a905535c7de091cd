"""Fixed frames whose names are misspelt."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.api.status import OtherFixedFrame
from webviz.data.transforms.reasons import Kind


class FixedFrameMisspelt(Check):
    """Fixed frame with a misspelt name.

    The fixed frame does not exist, and a known frame has almost the same name.

    Why:
        Everything is drawn in the fixed frame, so nothing is drawn while it is unknown.

    Repair:
        Choose the suggested frame as the fixed frame.
    """

    id = "TF002"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if a known frame resembles the fixed frame."""
        unknown = list(observation.unplaced(Kind.UNKNOWN_FIXED_FRAME))
        near = next((reason.near for _, reason in unknown if reason.near), "")
        if near:
            yield self.found(
                f'The fixed frame "{observation.fixed_frame}" does not exist, but "{near}" does.',
                f'Use "{near}" as the fixed frame.',
                subject=observation.fixed_frame,
                severity=Severity.ERROR,
                evidence={"fixed_frame": observation.fixed_frame, "nearest": near},
                button=OtherFixedFrame(near),
                explains=tuple(symptom for symptom, _ in unknown),
            )
