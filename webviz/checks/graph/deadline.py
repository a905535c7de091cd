"""Subscriptions whose deadline no publisher meets."""

from __future__ import annotations

import math
from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.api.offer import Endpoint
from webviz.data.words import listed

NAMED = 4


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

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic with such a subscription."""
        for topic, offer in observation.offers.items():
            waiting: list[tuple[Endpoint, float]] = []
            for reader in offer.readers:
                offered = [p.deadline_s for p in offer.publishers if p.type == reader.type]
                if offered and min(offered) > reader.deadline_s:
                    waiting.append((reader, min(offered)))
            if not waiting:
                continue
            best = min(offered for _, offered in waiting)
            promise = f"{best:g} s" if best < math.inf else "none"
            asked_s = min(reader.deadline_s for reader, _ in waiting)
            readers = listed([reader.label for reader, _ in waiting], NAMED)
            is_one = len(waiting) == 1
            yield self.found(
                f"{readers} {'receives' if is_one else 'receive'} nothing on {topic}: "
                f"{'it asks' if is_one else 'they ask'} for a deadline of {asked_s:g} s, and "
                f"{observation.nodes_of(topic)} offers {promise}.",
                "Remove the deadline of the subscription, or offer it in the publisher.",
                subject=topic,
                evidence={"topic": topic, "nodes": readers, "asked_s": asked_s},
                command=f"ros2 topic info --verbose {topic}",
            )
