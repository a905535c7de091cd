"""Maps of which nothing is known."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

KNOWN_CELLS = "known cells"
"""Measurement of displays of maps."""


class UnknownMap(Check):
    """Map without a known cell.

    All cells of a map are unknown.

    Why:
        A map is loaded with thresholds that no grey value meets, or SLAM has no scan that it can
        place. Planners have no free cell to start from.

    Repair:
        Check `free_thresh`, `occupied_thresh` and `mode` in the YAML of the map; with SLAM, whether
        its scans arrive and their frame leads to the base.
    """

    id = "DATA018"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such map."""
        for display in observation.displays:
            status = display.problem("Map")
            numbers = {each.name: each.value for each in status.values} if status else {}
            if numbers.get(KNOWN_CELLS) == 0.0:
                topic = next((each.topic for each in display.inputs), "")
                yield self.found(
                    f"All cells of {topic} are unknown.",
                    "Check the thresholds in the YAML of the map, or the scans that SLAM uses.",
                    subject=topic,
                    evidence={"topic": topic},
                    command=f"ros2 topic echo --once --field info {topic}",
                    explains=display.symptom("Map"),
                )
