"""Frames whose publishers contradict each other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.transforms.conflicts import ConflictKind


class ConflictCheck(Check):
    """Base of the checks of one sign of two publishers."""

    kind: ClassVar[ConflictKind]
    topic: ClassVar[str]
    """On which one of the publishers is found."""

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each frame with this sign."""
        for frame, conflict in seen.conflicts(self.kind):
            cause, _, _ = conflict.sentence.partition(":")
            nodes = seen.nodes_of(self.topic)
            yield self.found(
                f"{cause}.",
                "Stop one of the publishers.",
                subject=frame,
                evidence={"frame": frame, "parents": conflict.parents, "nodes": nodes},
                command=f"ros2 topic info {self.topic} --verbose",
                explains=seen.symptom("Transforms"),
            )
