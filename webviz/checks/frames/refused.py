"""Transforms that are refused."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

RECENT_NS = 5_000_000_000
OLD = "TF_OLD_DATA"


class RefusedTransforms(Check):
    """Transforms that are refused.

    Transforms arrive that tf2 refuses: with values that are not finite, a quaternion that is none,
    or a frame that is its own parent.

    Why:
        The frame keeps its last valid pose, or has none. An estimator that has diverged publishes
        NaN; a message that was never filled in has a quaternion of zeros.

    Repair:
        Correct the publisher. Print its transforms with

            ros2 topic echo /tf
    """

    id = "TF023"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each frame of which transforms were refused lately."""
        for frame, refused in seen.buffer.refusals.rejections.items():
            if seen.now_ns - refused.received_ns > RECENT_NS or refused.reason == OLD:
                continue
            yield self.found(
                f'Transforms of "{frame}" are refused: {refused.sentence}.',
                "Correct the publisher of the transform.",
                subject=frame,
                evidence={"frame": frame, "reason": refused.reason, "count": refused.count},
                command="ros2 topic echo /tf",
                explains=seen.symptom("Transforms"),
            )
