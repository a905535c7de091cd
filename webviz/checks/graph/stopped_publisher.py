"""Topics on which messages no longer arrive."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.checks.graph.silent_publisher import MAP, STREAMS

ON_CHANGE = MAP
"""Some mappers publish only while the robot moves."""


class StoppedPublisher(Check):
    """Messages that no longer arrive.

    Messages arrived at a steady rate, and then no more, although the publisher still exists. Of
    maps, paths, poses of localisation and others that are only sent while the robot moves, it is a
    note.

    Why:
        The node hangs, its sensor has failed, or the link to its machine has been lost: DDS notices
        a lost machine only after its lease of about 20 s.

    Repair:
        Look at the log of the node and at the sensor. Check whether its machine still answers.
    """

    id = "GRAPH009"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that fell silent."""
        for display, each, offer in seen.starved():
            if not each.received or not offer.publishers or offer.problem:
                continue
            who = seen.nodes_of(each.topic)
            rate = f"{each.rate_hz:.1f} Hz"
            yield self.found(
                f"{each.topic} stops in the bag; its rate was {rate}."
                if seen.is_recorded
                else f"Nothing has arrived on {each.topic} from {who} for {each.silence}, "
                f"previously at {rate}.",
                "Look at the log of the node and at its sensor."
                if seen.is_recorded
                else "Check the log of the node, its sensor, and the link to its machine.",
                subject=each.topic,
                severity=Severity.WARNING if each.type in STREAMS - {ON_CHANGE} else Severity.NOTE,
                evidence={
                    "topic": each.topic,
                    "rate_hz": round(each.rate_hz, 3),
                    "received": each.received,
                },
                command=f"ros2 topic hz {each.topic}",
                explains=display.symptom(each.status),
            )
