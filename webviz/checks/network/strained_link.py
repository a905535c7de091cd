"""Bridges whose link is slower than their topics."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class StrainedLink(Check):
    """Link to a bridge that loses messages or stalls.

    The bridge drops messages, sends warnings or frames that are invalid, or nothing comes from it.

    Why:
        A bridge keeps a queue for each viewer. If the link is slower than the subscribed topics,
        the queue fills, everything comes late, and the oldest messages are dropped.

    Repair:
        Hide displays of clouds and images, whose topics are then not subscribed to, or publish them
        at a lower rate. See where the time goes with the tab Topics.
    """

    id = "NET008"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each link with a remark."""
        for bridge in observation.bridges:
            if bridge.is_up and bridge.remarks and bridge.protocol != "Zenoh":
                keys = ("Connection", f"Connection to {bridge.title}")
                yield self.found(
                    bridge.remarks[0],
                    "Hide displays of large messages, or use a faster network.",
                    subject=bridge.name,
                    evidence={"bridge": bridge.name, "remarks": bridge.remarks},
                    explains=tuple(symptom for key in keys for symptom in observation.symptom(key)),
                )
