"""Data that a display cannot draw."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import DisplaySeen, Observation
from webviz.api.status import Level

OTHERS = {"Transform", "Links", "Display"}
"""Statuses that sum up what others say."""


class UndrawableData(Check):
    """Data that cannot be drawn.

    A display has received data that contradicts itself, or that it cannot read, and no other
    finding explains why.

    Why:
        The publisher fills in a size, a resolution, an encoding or a description that is wrong, or
        that only other programs understand. The sentence of the display has the numbers.

    Repair:
        Follow the sentence. Print the message with

            ros2 topic echo --once /map
    """

    id = "DATA019"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each error of a display about its data."""
        explained = {
            symptom
            for each in observation.findings
            if each.id != self.id
            for symptom in each.explains
        }
        for display in observation.displays:
            topic = next((each.topic for each in display.inputs if each.received), "")
            for key, text in _errors(display):
                if not topic or {*display.symptom(key)} & explained:
                    continue
                cause, _, remedy = text.partition(". ")
                yield self.found(
                    f"{display.display.name} cannot draw {topic}: {cause.rstrip('.')}.",
                    remedy or "Correct what its publisher sends.",
                    subject=f"{display.display.name}, {key}",
                    severity=Severity.ERROR,
                    evidence={"topic": topic, "status": text[:200]},
                    command=f"ros2 topic echo --once {topic}",
                    explains=display.symptom(key),
                )


def _errors(display: DisplaySeen) -> Iterator[tuple[str, str]]:
    """Yield keys and texts of the errors that are about the data itself."""
    topics = {each.status for each in display.inputs}
    for key, status in display.statuses.items():
        if status.level is Level.ERROR and status.reason is None and key not in topics | OTHERS:
            yield key, status.text
