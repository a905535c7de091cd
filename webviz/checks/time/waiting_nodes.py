"""Nodes that wait for simulated time."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import CauseLevel, Finding, Severity
from webviz.api.observation import NO_OFFER, Observation
from webviz.data.words import listed

NAMED = 5


class WaitingNodes(Check):
    """Nodes wait for /clock.

    Nodes have use_sim_time, nothing publishes /clock, and topics or transforms are missing.

    Why:
        The time of such a node is zero until a message arrives on /clock: its timers do not run,
        and it publishes nothing, or with stamps of zero. A launch file for a simulator that is used
        with a robot leaves it so.

    Repair:
        Start the simulator, or switch the parameter off for these nodes and start them again:

            ros2 param get /node use_sim_time
    """

    id = "TIME014"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        nodes = [node for node, follows in observation.sim_time.items() if follows]
        explains = observation.stalled()
        if not nodes or not explains or observation.offers.get("/clock", NO_OFFER).publishers:
            return
        named = listed(nodes, NAMED)
        yield self.found(
            f"{named} {'has' if len(nodes) == 1 else 'have'} use_sim_time, but nothing publishes "
            "/clock.",
            f"Start the simulator, or start {'it' if len(nodes) == 1 else 'them'} without "
            "use_sim_time.",
            severity=Severity.ERROR,
            evidence={"nodes": tuple(nodes)},
            command=f"ros2 param set {nodes[0]} use_sim_time false",
            explains=explains,
            causes=CauseLevel.GRAPH,
        )
