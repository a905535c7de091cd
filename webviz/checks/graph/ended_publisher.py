"""Topics whose publisher has ended."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class EndedPublisher(Check):
    """Publisher that has ended.

    Messages arrived on a topic that has no publisher any more.

    Why:
        The node has exited or crashed, or its machine is out of reach; what is shown is its last
        message.

    Repair:
        Start the node again. Its last words are in the log of its launch file, and in
        `~/.ros/log`.
    """

    id = "GRAPH011"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that has lost its publisher."""
        for display, each, offer in seen.starved():
            if not each.received or offer.publishers:
                continue
            yield self.found(
                f"{each.topic} no longer has a publisher.",
                "Start its node again, or restore the link to its machine.",
                subject=each.topic,
                evidence={"topic": each.topic, "received": each.received},
                command="ros2 node list",
                explains=display.symptom(each.status),
            )
