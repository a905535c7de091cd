"""Subscriptions that ask for more durability than is offered."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import ChangeDisplay, Finding, Severity
from webviz.api.observation import Observation
from webviz.api.status import Remedy


class DurabilityMismatch(Check):
    """Durability does not match.

    A display asks for transient local messages on a topic that is published as volatile only.

    Why:
        A transient local subscription wants what was sent before it existed. DDS does not connect
        it to a publisher that keeps nothing.

    Repair:
        Set the durability of the display to `auto`. For maps and robot descriptions, make the
        publisher transient local instead, so that late subscribers receive the last message.
    """

    id = "GRAPH006"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that is requested as latched and offered as volatile."""
        for display, each, offer in observation.starved():
            offered = {
                p.durability for p in offer.publishers if p.type in each.types and p.is_qos_known
            }
            is_asked = each.latched or each.qos.durability == "transient_local"
            if offer.is_recorded or offered != {"volatile"} or not is_asked:
                continue
            who = observation.nodes_of(each.topic)
            change = Remedy(f"{each.path}.durability", "auto", "Set durability to automatic")
            yield self.found(
                f"{display.display.name} asks for transient local messages on {each.topic}, but "
                f"{who} offers volatile ones.",
                f"Make {who} publish as transient local."
                if each.latched
                else "Set the durability of the display to auto.",
                subject=each.topic,
                severity=Severity.ERROR,
                evidence={
                    "topic": each.topic,
                    "requested": "transient_local",
                    "offered": "volatile",
                },
                button=None if each.latched else ChangeDisplay(display.id, change),
                explains=display.symptom(each.status),
            )
