"""Simulated time that stands still."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import CauseLevel, Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import in_words

STILL_S = 1.0
"""Shorter than a topic is silent before that is a warning, which this explains."""


class ClockStands(Check):
    """/clock stands still.

    A node publishes /clock, its time does not move, and topics or transforms are missing.

    Why:
        A simulator or a bag that is paused stops all nodes with use_sim_time: their timers do not
        run, and they publish nothing. They are not at fault.

    Repair:
        Resume the simulator or the playback of the bag. Nodes that are to run on wall time must not
        have use_sim_time:

            ros2 param get /node use_sim_time
    """

    id = "TIME013"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        clock, offer, explains = (
            observation.clock,
            observation.offers.get("/clock"),
            observation.stalled(),
        )
        if (
            clock is None
            or offer is None
            or not observation.now_ns
            or observation.is_paused
            or not explains
        ):
            return
        if clock.still_s < STILL_S or len(offer.publishers) != 1:
            return
        node, since = observation.nodes_of("/clock"), in_words(round(clock.still_s * 1e9))
        what = f"Nothing has arrived on /clock from {node} since webviz subscribed {since} ago"
        if clock.time_ns is not None:
            what = f"Simulated time stands still at {clock.time_ns / 1e9:.1f} s ({node})"
        yield self.found(
            f"{what}, so nodes with use_sim_time wait.",
            "Resume the simulator or the playback of the bag.",
            severity=Severity.ERROR,
            evidence={
                "node": node,
                "time_s": None if clock.time_ns is None else clock.time_ns / 1e9,
                "still_s": round(clock.still_s, 1),
            },
            command="ros2 topic echo /clock",
            explains=explains,
            causes=CauseLevel.GRAPH,
        )
