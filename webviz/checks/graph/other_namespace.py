"""Topics that are published in another namespace."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import ChangeDisplay, Finding
from webviz.api.observation import Observation
from webviz.checks.graph.names import is_elsewhere, suggested


class OtherNamespace(Check):
    """Topic in another namespace.

    A display subscribes to a topic that no node publishes, and a topic of the same type has the
    same name in another namespace.

    Why:
        A launch file that puts a robot into a namespace moves all its topics; displays and nodes
        with absolute names do not follow.

    Repair:
        Choose the suggested topic, or start webviz in the namespace of the robot:

            webviz --ros-args -r __ns:=/robot1
    """

    id = "GRAPH003"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that only another namespace has."""
        for display, each, offer in seen.starved():
            remedy = suggested(display, each)
            if offer.publishers or each.received or not remedy:
                continue
            if is_elsewhere(each.topic, remedy.value):
                yield self.found(
                    f"No node publishes {each.topic}, but {remedy.value} is published.",
                    f"Choose {remedy.value}, or start webviz in that namespace.",
                    subject=each.topic,
                    evidence={"topic": each.topic, "nearest": remedy.value},
                    button=ChangeDisplay(display.id, remedy),
                    explains=display.symptom(each.status),
                )
