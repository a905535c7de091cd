"""Frame ids that begin with a slash."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class LeadingSlash(Check):
    """Frame id with a leading slash.

    A frame id begins with a slash, as it did in ROS 1.

    Why:
        tf2 refuses such names. webviz ignores the slash, but other nodes do not find the frame.

    Repair:
        Remove the slash where the frame id is set, often a parameter such as `frame_id: /laser`.
    """

    id = "TF014"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame id."""
        names = [
            (each.frame, each.topic) for _, each in observation.inputs() if each.frame[:1] == "/"
        ]
        explains = tuple(symptom for symptom, _ in observation.unplaced(Kind.LEADING_SLASH))
        if observation.fixed_frame[:1] == "/":
            names.append((observation.fixed_frame, "the fixed frame"))
        for frame, where in names:
            yield self.found(
                f'The frame id "{frame}" ({where}) begins with a slash.',
                f'Set it to "{frame.lstrip("/")}".',
                subject=frame,
                evidence={"frame": frame, "where": where},
                explains=explains,
            )
