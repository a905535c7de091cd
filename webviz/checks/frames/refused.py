"""Transforms that are refused."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind

OLD = "TF_OLD_DATA"


class RefusedTransforms(Check):
    """Transforms that are refused.

    Transforms arrive that tf2 refuses: with values that are not finite, an invalid quaternion,
    or a frame that is its own parent.

    Why:
        The frame keeps its last valid pose, or has none. An estimator that has diverged publishes
        NaN; a message that was never filled in has a quaternion of zeros.

    Repair:
        Correct the publisher, and start it again if the transform is static, since it is sent once
        only. Print transforms with

            ros2 topic echo /tf
    """

    id = "TF023"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each frame whose transform is refused, or that lacks it since."""
        refusals = [
            (reason.link, symptom)
            for symptom, reason in observation.unplaced(Kind.REFUSED, Kind.AHEAD, Kind.NO_DATA)
            if reason.kind is Kind.REFUSED or is_refused(observation, reason.link)
        ]
        causes = {link for link, _ in refusals}
        for frame, refused in observation.buffer.refusals.rejections.items():
            is_current = refused.is_current(observation.now_ns) or frame in causes
            if not is_current or refused.reason == OLD:
                continue
            topic = "/tf_static" if refused.is_static else "/tf"
            yield self.found(
                f'Transforms of "{frame}" are refused: {refused.sentence}.',
                "Correct the publisher of the transform.",
                subject=frame,
                evidence={"frame": frame, "reason": refused.reason, "count": refused.count},
                command=f"ros2 topic echo {topic}",
                explains=(
                    *(symptom for link, symptom in refusals if link == frame),
                    *observation.symptom("Transforms"),
                ),
            )


def is_refused(observation: Observation, frame: str) -> bool:
    """Return whether a frame lacks transforms because its publisher sends invalid ones."""
    refused = observation.buffer.refusals.rejections.get(frame)
    return refused is not None and refused.reason != OLD and refused.is_current(observation.now_ns)
