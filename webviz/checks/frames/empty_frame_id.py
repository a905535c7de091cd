"""Messages that name no frame."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class EmptyFrameId(Check):
    """Empty frame id.

    The header of a message has an empty frame id.

    Why:
        The data has no place without a frame. Drivers leave it empty if a parameter is not set.

    Repair:
        Set the parameter `frame_id` of the driver, or fill in `header.frame_id` where the message
        is made.
    """

    id = "TF015"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for symptom, reason in observation.unplaced(Kind.EMPTY_FRAME):
            if not observation.fixed_frame:
                continue
            yield self.found(
                "The messages of a display have no frame id.",
                "Set header.frame_id in the publisher.",
                subject=reason.link or reason.frame,
                severity=Severity.ERROR,
                evidence={"display": symptom.display},
                explains=(symptom,),
            )
