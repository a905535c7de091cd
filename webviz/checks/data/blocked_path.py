"""Paths that lead through obstacles."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class BlockedPath(Check):
    """Path through an obstacle.

    A path leads through points that the laser sees.

    Why:
        The planner does not know the obstacle: its costmap does not subscribe to the scan, or it
        has not replanned.

    Repair:
        Check `observation_sources` of the obstacle layer, and that the planner runs.
    """

    id = "DATA005"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such path."""
        for display in observation.displays:
            if display.blocked and display.problem("Obstacles"):
                yield self.found(
                    f"The path leads through {display.blocked} points of the laser scan.",
                    "Check that the costmap of the planner subscribes to the scan.",
                    subject=display.display.name,
                    evidence={"points": display.blocked},
                    explains=display.symptom("Obstacles"),
                )
