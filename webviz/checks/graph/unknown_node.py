"""Publishers without a node."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class UnknownNode(Check):
    """Publisher of an unknown node.

    A topic has a publisher that belongs to no known ROS node.

    Why:
        It is a program of DDS without ROS, such as a bridge, or a node whose announcement was lost.
        If it sends nothing, its node cannot be asked why.

    Repair:
        Start discovery again, and look at the endpoint:

            ros2 topic info -v /scan
    """

    id = "GRAPH013"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for display, each, offer in seen.starved():
            if each.received or not offer.publishers:
                continue
            if all(not publisher.node for publisher in offer.publishers):
                yield self.found(
                    f"The publisher of {each.topic} belongs to no known node and sends nothing.",
                    "Check the DDS program or bridge that offers the topic.",
                    subject=each.topic,
                    severity=Severity.NOTE,
                    evidence={"publishers": len(offer.publishers)},
                    command=f"ros2 topic info -v {each.topic}",
                    explains=display.symptom(each.status),
                )
