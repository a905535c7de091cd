"""Frames that nothing publishes."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class UnknownFrame(Check):
    """Unknown frame.

    Data is in a frame to which no transform leads.

    Why:
        The sensor is not part of the robot description, or the node that publishes its transform is
        not running.

    Repair:
        Add the sensor to the URDF, or publish where it is mounted:

            ros2 run tf2_ros static_transform_publisher --frame-id base_link --child-frame-id laser
    """

    id = "TF017"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for symptom, reason in seen.lost(Kind.UNKNOWN_FRAME):
            if reason.near:
                continue
            yield self.found(
                f'No transform leads to the frame "{reason.frame}".',
                "Publish where it is mounted, or correct the frame id of the data.",
                subject=reason.link or reason.frame,
                severity=Severity.ERROR,
                evidence={"frame": reason.frame},
                command="ros2 run tf2_ros static_transform_publisher "
                f"--frame-id base_link --child-frame-id {reason.frame}",
                explains=(symptom,),
            )
