"""Publishers without a node."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.checks.graph.silence import is_nameless, is_silent
from webviz.checks.graph.silent_publisher import STREAMS


class UnknownNode(Check):
    """Publisher of an unknown node.

    A topic has a publisher that belongs to no known ROS node, and no message has arrived. Of goals,
    paths and others that are sent on an event it is a note.

    Why:
        It is a program of DDS without ROS, such as a bridge, or a node whose announcement was lost.
        No node can be asked why it sends nothing.

    Repair:
        Start discovery again, and look at the endpoint:

            ros2 topic info -v /scan
    """

    id = "GRAPH013"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for display, each, offer in observation.starved():
            if is_silent(observation, display, each, offer) and is_nameless(offer):
                yield self.found(
                    f"Nothing has arrived on {each.topic}, whose publisher belongs to no known "
                    "node.",
                    "Check the DDS program or bridge that offers the topic.",
                    subject=each.topic,
                    severity=Severity.WARNING if {*each.types} & STREAMS else Severity.NOTE,
                    evidence={"publishers": len(offer.publishers)},
                    command=f"ros2 topic info -v {each.topic}",
                    explains=display.symptom(each.status),
                )
