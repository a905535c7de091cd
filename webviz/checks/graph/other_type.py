"""Topics of another message type."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import ChangeDisplay, Finding, Severity
from webviz.api.observation import Observation
from webviz.api.status import Remedy


class OtherType(Check):
    """Topic of another message type.

    A display subscribes to a topic that is published with a type it cannot read.

    Why:
        DDS matches publishers and subscriptions by topic and type, so no message arrives.

    Repair:
        Choose a topic of the type that the display shows, or add a display for the type of the
        topic. Print the type with

            ros2 topic type /scan
    """

    id = "GRAPH004"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that is published, but not with a type of its display."""
        for display, each, offer in observation.starved():
            published = sorted({publisher.type for publisher in offer.publishers})
            if not published or {*published} & {*each.types}:
                continue
            status = display.problem(each.status)
            remedy = status and status.remedy
            yield self.found(
                f"{each.topic} is published as {' and '.join(published)}, which a display of the "
                f"type {display.type} cannot show.",
                f"Choose a topic of the type {' or '.join(each.types)}, or another display.",
                subject=each.topic,
                severity=Severity.ERROR,
                evidence={"topic": each.topic, "published": tuple(published), "shown": each.types},
                button=ChangeDisplay(display.id, remedy) if isinstance(remedy, Remedy) else None,
                explains=display.symptom(each.status),
            )
