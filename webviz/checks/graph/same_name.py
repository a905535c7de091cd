"""Nodes that have the same name."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.sources.names import is_own

SHARED = {"/tf", "/tf_static", "/rosout", "/parameter_events", "/diagnostics", "/clock"}
"""Topics that many nodes publish."""


class SameName(Check):
    """Two nodes have one name.

    Several nodes of the graph have the same full name. It is a note unless they also publish the
    same topic, and of viewers.

    Why:
        Services and parameters of the name are answered by any of them. Usually a node was started
        twice, such as by two launch files or on two robots without namespaces, so that its
        messages and transforms come from two sources. A node that was killed stays in the graph
        for about 20 s.

    Repair:
        End one of them, or give it another name or namespace:

            ros2 run my_package my_node --ros-args -r __node:=other -r __ns:=/robot2
    """

    id = "GRAPH015"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such name."""
        for node, number in Counter(observation.nodes).items():
            both = sorted(
                topic
                for topic, offer in observation.offers.items()
                if topic not in SHARED and sum(p.node == node for p in offer.publishers) > 1
            )
            if is_own(node):
                yield from self._viewers(observation, node, both)
            if number < 2 or is_own(node):
                continue
            too = f", and publish {both[0]}" if both else ""
            yield self.found(
                f"{number} nodes have the name {node}{too}.",
                "End one of them, or give it another name or namespace.",
                subject=node,
                severity=Severity.WARNING if both else Severity.NOTE,
                evidence={"node": node, "number": number, "topics": tuple(both[:10])},
                command="ros2 node list",
                explains=observation.symptom("Transforms") if both else (),
            )

    def _viewers(
        self, observation: Observation, node: str, topics: Sequence[str]
    ) -> Iterator[Finding]:
        """Yield a note if several viewers run; `webviz doctor` has the name, but no publisher."""
        counts = (
            sum(p.node == node for p in observation.offers[each].publishers) for each in topics
        )
        if number := max(counts, default=0):
            yield self.found(
                f"{number} viewers have the name {node}.",
                "To set parameters or call services of one of them, give it a namespace.",
                subject=node,
                severity=Severity.NOTE,
                evidence={"node": node, "number": number, "topics": tuple(topics[:10])},
                command="webviz --ros-args -r __ns:=/second",
            )
