"""Subscriptions whose deadline no publisher meets."""

from __future__ import annotations

import math
from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class DeadlineMismatch(Check):
    """Deadline does not match.

    A node subscribes with a shorter deadline than the publisher offers.

    Why:
        DDS connects a subscription only to a publisher that promises messages at least as often as
        it asks for. The node receives nothing; webviz, which asks for no deadline, shows the topic.

    Repair:
        Remove the deadline of the subscription, or offer a shorter one in the publisher. Print both
        with

            ros2 topic info --verbose /scan
    """

    id = "GRAPH014"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic with such a subscription."""
        for topic, offer in seen.offers.items():
            for reader in offer.readers:
                offered = [p.deadline_s for p in offer.publishers if p.type == reader.type]
                if not offered or min(offered) <= reader.deadline_s:
                    continue
                promise = f"{min(offered):g} s" if min(offered) < math.inf else "none"
                yield self.found(
                    f"{reader.label} receives nothing on {topic}: it asks for a deadline of "
                    f"{reader.deadline_s:g} s, and {seen.nodes_of(topic)} offers {promise}.",
                    "Remove the deadline of the subscription, or offer it in the publisher.",
                    subject=topic,
                    evidence={"topic": topic, "node": reader.label, "asked_s": reader.deadline_s},
                    command=f"ros2 topic info --verbose {topic}",
                )
