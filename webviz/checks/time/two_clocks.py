"""Several publishers of /clock."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import CauseLevel, Finding
from webviz.api.observation import Observation


class TwoClocks(Check):
    """Two publishers of /clock.

    More than one node publishes /clock.

    Why:
        Time jumps between the two clocks. Each jump back discards all transforms, here and in every
        other node.

    Repair:
        Stop one of them, often a second `ros2 bag play --clock` beside a simulator.
    """

    id = "TIME003"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        offer = observation.offers.get("/clock")
        nodes = tuple(p.label for p in offer.publishers) if offer and not offer.is_recorded else ()
        if len(nodes) > 1:
            yield self.found(
                f"{len(nodes)} nodes publish /clock: {', '.join(nodes)}.",
                "Stop all but one of them.",
                evidence={"nodes": nodes},
                command="ros2 topic info /clock --verbose",
                explains=(*observation.stalled(), *observation.symptom("Clocks")),
                causes=CauseLevel.GRAPH,
            )
