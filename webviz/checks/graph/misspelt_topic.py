"""Topics whose names are misspelt."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import ChangeDisplay, Finding
from webviz.api.observation import Observation
from webviz.checks.graph.names import is_elsewhere, suggested


class MisspeltTopic(Check):
    """Topic with a misspelt name.

    A display subscribes to a topic that no node publishes, and a topic of the same type has almost
    the same name.

    Why:
        ROS creates a topic for any name, so a typing error is not an error.

    Repair:
        Choose the suggested topic, or correct the name in the launch file of its publisher.
    """

    id = "GRAPH002"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic without a publisher that resembles a published one."""
        for display, each, offer in observation.starved():
            remedy = suggested(display, each)
            if offer.publishers or each.received or not remedy:
                continue
            if is_elsewhere(each.topic, remedy.value):
                continue
            yield self.found(
                f"No node publishes {each.topic}, but {remedy.value} has a similar name.",
                f"Choose {remedy.value}.",
                subject=each.topic,
                evidence={"topic": each.topic, "nearest": remedy.value},
                button=ChangeDisplay(display.id, remedy),
                explains=display.symptom(each.status),
            )
