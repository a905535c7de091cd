"""Displays without a topic."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class NoTopic(Check):
    """Display without a topic.

    A display has no topic, or a name that is not valid.

    Why:
        It subscribes to nothing.

    Repair:
        Choose a topic in the display.
    """

    id = "VIEW002"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such display."""
        for display in observation.displays:
            for each in display.inputs:
                if not each.topic and display.problem(each.status):
                    yield self.found(
                        f"{display.display.name} has no topic.",
                        "Choose a topic.",
                        subject=display.display.name,
                        evidence={"property": each.path},
                        explains=display.symptom(each.status),
                    )
