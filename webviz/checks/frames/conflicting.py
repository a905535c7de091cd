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
        """Yield a finding for the frames with this sign that have the same parents."""
        found: dict[tuple[str, ...], list[tuple[str, str]]] = {}
        for frame, conflict in seen.conflicts(self.kind):
            cause, _, _ = conflict.sentence.partition(":")
            found.setdefault(conflict.parents, []).append((frame, cause))
        for parents, several in found.items():
            frame, cause = several[0]
            more = f", and so have {len(several) - 1} other frames" if len(several) > 1 else ""
            yield self.found(
                f"{cause}{more}.",
                "Stop one of the publishers.",
                subject=frame,
                evidence={
                    "frames": tuple(name for name, _ in several),
                    "parents": parents,
                    "nodes": seen.nodes_of(self.topic),
                },
                command=f"ros2 topic info {self.topic} --verbose",
                explains=seen.symptom("Transforms"),
            )
