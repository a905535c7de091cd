"""Simulated time without a clock."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import CauseLevel, Finding, Severity
from webviz.api.observation import Observation


class ClockMissing(Check):
    """use_sim_time without /clock.

    webviz follows simulated time, and no message has arrived on /clock.

    Why:
        With use_sim_time, a node takes its time from /clock. Before the first message on /clock,
        data with a stamp cannot be placed.

    Repair:
        Start the simulator, or play the bag with its clock:

            ros2 bag play run --clock 100
    """

    id = "TIME001"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        if observation.now_ns or observation.is_recorded:
            return
        nodes = observation.nodes_of("/clock")
        yield self.found(
            f"webviz follows simulated time, and nothing has arrived on /clock from {nodes}."
            if nodes
            else "webviz follows simulated time, but nothing publishes /clock.",
            "Start or resume the simulator, or start webviz without use_sim_time.",
            severity=Severity.ERROR,
            evidence={"publishers": nodes},
            command="ros2 topic hz /clock",
            explains=observation.stalled(),
            causes=CauseLevel.GRAPH,
        )
