"""Topics that are published in another namespace."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import ChangeDisplay, Finding
from webviz.api.observation import DisplaySeen, InputSeen, Observation
from webviz.api.status import Remedy
from webviz.checks.graph.names import is_elsewhere, suggested
from webviz.data.words import listed

NAMED = 4


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

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each namespace in which topics are missing, and another has them."""
        by_namespaces: dict[tuple[str, str], list[tuple[DisplaySeen, InputSeen, Remedy]]] = {}
        for display, each, offer in observation.starved():
            remedy = suggested(display, each)
            if offer.publishers or each.received or not remedy:
                continue
            if is_elsewhere(each.topic, remedy.value):
                by_namespaces.setdefault(_namespaces(each.topic, remedy.value), []).append(
                    (display, each, remedy)
                )
        for (_, other), missing in by_namespaces.items():
            topics = [*dict.fromkeys(each.topic for _, each, _ in missing)]
            display, each, remedy = missing[0]
            is_one = len(topics) == 1
            yield self.found(
                f"No node publishes {each.topic}, but {remedy.value} is published."
                if is_one
                else f"No node publishes {listed(topics, NAMED)}, but they are published in "
                f"{other or '/'}.",
                f"Choose {remedy.value}, or start webviz in that namespace."
                if is_one
                else f"Start webviz in the namespace {other or '/'}, or choose its topics.",
                subject=each.topic,
                evidence={"topics": tuple(topics), "nearest": remedy.value},
                command=f"webviz --ros-args -r __ns:={other}" if other else "",
                button=ChangeDisplay(display.id, remedy),
                explains=tuple(
                    symptom for d, one, _ in missing for symptom in d.symptom(one.status)
                ),
            )


def _namespaces(topic: str, other: str) -> tuple[str, str]:
    """Return what differs at the beginning of two topics that end alike."""
    first, second = topic.split("/"), other.split("/")
    while first and second and first[-1] == second[-1]:
        del first[-1], second[-1]
    return "/".join(first), "/".join(second)
