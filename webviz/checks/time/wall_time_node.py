"""Nodes on wall time beside a simulator."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import WALL_NS, YEAR_NS


class WallTimeNode(Check):
    """One node on wall time.

    Time is simulated, and the stamps of a topic are wall time.

    Why:
        tf2 finds no transform at such a stamp, so that nothing of this node can be placed.

    Repair:
        Set use_sim_time for that node, too, in its launch file or with

            ros2 param set /node use_sim_time true
    """

    id = "TIME005"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        if not observation.is_simulated or not 0 < observation.now_ns < YEAR_NS:
            return
        for display, each in observation.inputs():
            if each.stamps and each.stamps[-1][0] > WALL_NS:
                nodes = observation.nodes_of(each.topic)
                yield self.found(
                    f"{nodes} stamps {each.topic} with wall time, while time is simulated.",
                    f"Set use_sim_time for {nodes}.",
                    subject=each.topic,
                    severity=Severity.ERROR,
                    evidence={"topic": each.topic, "nodes": nodes},
                    command=f"ros2 param set {nodes.partition(',')[0]} use_sim_time true",
                    explains=display.symptom("Transform"),
                )
