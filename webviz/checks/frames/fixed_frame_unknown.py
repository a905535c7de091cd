"""Fixed frames that nothing publishes."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.api.status import OtherFixedFrame
from webviz.data.transforms.reasons import Kind


class FixedFrameUnknown(Check):
    """Fixed frame that does not exist.

    No transform names the fixed frame, and no known frame has a similar name.

    Why:
        Everything is drawn in the fixed frame, so nothing is drawn while it is unknown.

    Repair:
        Choose a frame that exists; the root of the largest tree shows most.
    """

    id = "TF004"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if the fixed frame is unknown."""
        unknown = [
            each for each in observation.unplaced(Kind.UNKNOWN_FIXED_FRAME) if not each[1].near
        ]
        if unknown:
            root, size = observation.buffer.largest_tree()
            yield self.found(
                f'The fixed frame "{observation.fixed_frame}" does not exist.',
                f'Use "{root}", the root of the largest tree.',
                subject=observation.fixed_frame,
                severity=Severity.ERROR,
                evidence={"fixed_frame": observation.fixed_frame, "root": root, "frames": size},
                button=OtherFixedFrame(root),
                explains=tuple(symptom for symptom, _ in unknown),
            )
