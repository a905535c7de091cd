"""Queues that are too short for their transforms."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class QueueFull(Check):
    """Queue too short for its transform.

    Messages are dropped while they wait for a transform, because more arrive than the queue holds.

    Why:
        A display keeps `filter_size` messages until their transform is there. If it takes longer
        than that many messages, none is ever drawn.

    Repair:
        Raise the filter size of the topic, or the rate of the transform.
    """

    id = "TF021"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for symptom, reason in observation.unplaced(Kind.QUEUE_FULL):
            yield self.found(
                f'Messages in "{reason.frame}" are dropped before their transform arrives.',
                f"Set the filter size of the topic to {reason.filter_size}.",
                subject=reason.link or reason.frame,
                severity=Severity.ERROR,
                evidence={"frame": reason.frame, "filter_size": reason.filter_size},
                explains=(symptom,),
            )
