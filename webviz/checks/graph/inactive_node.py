"""Lifecycle nodes from which nothing arrives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import NO_OFFER, Observation
from webviz.api.offer import Publisher
from webviz.checks.graph.silence import is_silent

EVENT = "lifecycle_msgs/msg/TransitionEvent"


class InactiveNode(Check):
    """Lifecycle node from which nothing arrives.

    A topic is published by a lifecycle node, and no message has arrived.

    Why:
        A lifecycle node publishes only while it is `active`. Something has to configure and
        activate it, such as a launch file or the lifecycle manager of Nav2, which stops at the
        first node that fails.

    Repair:
        Print the state of the node, and activate it if it is inactive:

            ros2 lifecycle get /slam_toolbox
            ros2 lifecycle set /slam_toolbox activate
    """

    id = "GRAPH012"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each silent topic of lifecycle nodes."""
        for display, each, offer in observation.starved():
            nodes = lifecycle_nodes(observation, offer.publishers)
            if nodes and is_silent(observation, display, each, offer):
                yield self.found(
                    f"Nothing has arrived on {each.topic} from {nodes[0]}, a lifecycle node that "
                    "is probably not active.",
                    "Configure and activate the node.",
                    subject=each.topic,
                    evidence={"topic": each.topic, "nodes": tuple(nodes)},
                    command=f"ros2 lifecycle get {nodes[0]}",
                    explains=display.symptom(each.status),
                )


def lifecycle_nodes(observation: Observation, publishers: Sequence[Publisher]) -> Sequence[str]:
    """Return the lifecycle nodes among the nodes of publishers, by their transition topics."""
    return [
        publisher.node
        for publisher in publishers
        if publisher.node
        and any(
            other.type == EVENT
            for other in observation.offers.get(
                f"{publisher.node}/transition_event", NO_OFFER
            ).publishers
        )
    ]
