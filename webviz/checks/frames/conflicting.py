"""Frames whose publishers contradict each other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.transforms.conflicts import ConflictKind
from webviz.data.words import Problem, counted, joined


class ConflictCheck(Check):
    """Base of the checks of one sign of two publishers."""

    kind: ClassVar[ConflictKind]
    topic: ClassVar[str]
    """Topic on which one of the publishers is found."""

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for the frames with this sign that have the same parents."""
        conflicts: dict[tuple[str, ...], list[tuple[str, Problem]]] = {}
        for frame, conflict in observation.conflicts(self.kind):
            conflicts.setdefault(conflict.parents, []).append((frame, conflict.problem))
        for parents, several in conflicts.items():
            frame, problem = several[0]
            others = len(several) - 1
            more = f"The same holds for {counted(others, 'other frame')}." if others else ""
            yield self.found(
                joined(problem.cause, more),
                problem.remedy,
                subject=frame,
                evidence={
                    "frames": tuple(name for name, _ in several),
                    "parents": parents,
                    "nodes": observation.nodes_of(self.topic),
                },
                command=f"ros2 topic info {self.topic} --verbose",
                explains=(*observation.symptom("Transforms"), *observation.off_map()),
            )
