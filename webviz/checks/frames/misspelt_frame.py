"""Frame ids that are misspelt."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class MisspeltFrame(Check):
    """Misspelt frame id.

    Data is in a frame that does not exist, and a known frame has almost the same name.

    Why:
        Frame ids are plain text, which nothing checks: `Laser`, `laser_link` and `robot1/laser` are
        different frames.

    Repair:
        Use one name in the driver and in the robot description.
    """

    id = "TF016"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for symptom, reason in observation.unplaced(Kind.UNKNOWN_FRAME):
            if not reason.near:
                continue
            yield self.found(
                f'The frame "{reason.frame}" does not exist, but "{reason.near}" does.',
                f'Set the frame id of the data to "{reason.near}".',
                subject=reason.link or reason.frame,
                severity=Severity.ERROR,
                evidence={"frame": reason.frame, "nearest": reason.near},
                explains=(symptom,),
            )
