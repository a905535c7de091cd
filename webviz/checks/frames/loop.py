"""Frames that form a loop."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity, Symptom
from webviz.api.observation import Observation
from webviz.data.transforms.diagnosis import loops
from webviz.data.transforms.reasons import Kind, listed


class LoopOfFrames(Check):
    """Loop of frames.

    Following the parents of a frame leads back to it.

    Why:
        Two publishers disagree about which of two frames is the parent, such as an odometry that
        publishes `base_link` to `odom` and a filter that publishes `odom` to `base_link`. No pose
        can be computed for any frame of the loop.

    Repair:
        Let one of the publishers not publish its transform.
    """

    id = "TF007"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each loop."""
        symptoms: list[Symptom] = [symptom for symptom, _ in observation.unplaced(Kind.LOOP)]
        for loop in loops(observation.buffer):
            yield self.found(
                f"The frames {listed(loop, ' → ')} form a loop.",
                "Stop one of the two publishers that disagree about the parents.",
                subject=" ".join(sorted(set(loop))[:8]),
                severity=Severity.ERROR,
                evidence={"loop": loop[:10], "publishers": observation.nodes_of("/tf")},
                command="ros2 topic info /tf --verbose",
                explains=tuple(symptoms),
            )
