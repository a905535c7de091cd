"""Publishers that have sent nothing."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class SilentPublisher(Check):
    """Publisher that sends nothing.

    A topic has a publisher that matches the display, but no message has arrived.

    Why:
        The node runs and waits for something itself: a sensor that is off, an input topic, or its
        activation, if it is a lifecycle node.

    Repair:
        Look at the log of the node. Of a lifecycle node, print the state, which must be `active`:

            ros2 lifecycle get /slam_toolbox
    """

    id = "GRAPH008"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that is published, matches, and is silent."""
        for display, each, offer in seen.starved():
            publishers = [p for p in offer.publishers if p.type in each.types]
            if each.received or offer.problem or not publishers or seen.is_recorded:
                continue
            is_refused = offer.requested is None or display.problem(each.status) is None
            if is_refused or (display.statuses[each.status].remedy is not None):
                continue
            node = publishers[0].label
            yield self.found(
                f"{node} publishes {each.topic}, but has sent nothing yet.",
                "Check what the node waits for: its sensor, its inputs, or its activation.",
                subject=each.topic,
                evidence={"topic": each.topic, "nodes": tuple(p.label for p in publishers)},
                command=f"ros2 node info {node}" if publishers[0].node else "",
                explains=display.symptom(each.status),
            )
