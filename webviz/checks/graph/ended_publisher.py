"""Nodes that have ended."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import NO_OFFER, DisplaySeen, InputSeen, Observation
from webviz.data.words import listed

NAMED = 4


class EndedPublisher(Check):
    """Node that has ended.

    Messages arrived on topics that have no publisher any more.

    Why:
        The node has exited, crashed or was stopped, or its machine is out of reach; what is shown
        is its last message.

    Repair:
        Start the node again. Its last words are in the log of its launch file, and in
        `~/.ros/log`.
    """

    id = "GRAPH011"

    def __init__(self) -> None:
        self._nodes: dict[str, str] = {}
        """The last known publishers, by topic."""

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each node that has ended; several that left together are one."""
        by_node: dict[str, list[tuple[DisplaySeen, InputSeen]]] = {}
        for display, each in observation.inputs():
            offer = observation.offers.get(each.topic, NO_OFFER)
            if offer.publishers:
                self._nodes[each.topic] = observation.nodes_of(each.topic)
            elif each.received and display.problem(each.status):
                node = self._nodes.get(each.topic, "")
                by_node.setdefault(node or each.topic, []).append((display, each))
        for inputs in by_node.values():
            topics = [*dict.fromkeys(each.topic for _, each in inputs)]
            node = self._nodes.get(topics[0], "")
            has_ended = node and not {*node.split(", ")} & {*observation.nodes}
            named = listed(topics, NAMED)
            no_longer = "no longer has" if len(topics) == 1 else "no longer have"
            yield self.found(
                f"{node} has left the graph, so {named} {no_longer} a publisher."
                if has_ended
                else f"{named} {no_longer} a publisher.",
                "Start its node again, or restore the link to its machine.",
                subject=topics[0],
                evidence={
                    "topics": tuple(topics),
                    "node": node,
                    "received": sum(each.received for _, each in inputs),
                },
                command="ros2 node list",
                explains=tuple(
                    s
                    for display, each in inputs
                    for s in (*display.symptom(each.status), *observation.outlived(display))
                ),
            )
