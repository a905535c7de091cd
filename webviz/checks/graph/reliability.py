"""Subscriptions that ask for more reliability than is offered."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import ChangeDisplay, Finding, Severity
from webviz.api.observation import Observation
from webviz.api.status import Remedy


class ReliabilityMismatch(Check):
    """Reliability does not match.

    A display asks for reliable messages on a topic that is published best effort only.

    Why:
        DDS connects a reliable subscription only to a reliable publisher. Sensor drivers usually
        publish best effort, so the default of many nodes receives nothing.

    Repair:
        Set the reliability of the display to `auto`, which follows the publisher.
    """

    id = "GRAPH005"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that is requested as reliable and offered best effort."""
        for display, each, offer in observation.starved():
            offered = {
                p.reliability for p in offer.publishers if p.type in each.types and p.is_qos_known
            }
            if (
                offer.is_recorded
                or offered != {"best_effort"}
                or each.qos.reliability != "reliable"
            ):
                continue
            yield self.found(
                f"{display.display.name} asks for reliable messages on {each.topic}, but "
                f"{observation.nodes_of(each.topic)} offers best effort.",
                "Set the reliability of the display to auto.",
                subject=each.topic,
                severity=Severity.ERROR,
                evidence={"topic": each.topic, "requested": "reliable", "offered": "best_effort"},
                button=ChangeDisplay(
                    display.id,
                    Remedy(f"{each.path}.reliability", "auto", "Set reliability to automatic"),
                ),
                explains=display.symptom(each.status),
            )
