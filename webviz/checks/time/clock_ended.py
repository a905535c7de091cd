"""Simulated time whose clock has ended."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import CauseLevel, Finding
from webviz.api.observation import Observation


class ClockEnded(Check):
    """/clock has ended.

    Simulated time stands still, and /clock no longer has a publisher.

    Why:
        All nodes with use_sim_time stand still with it: timers do not run, and stamps stay the
        same.

    Repair:
        Start the simulator or the playback of the bag again.
    """

    id = "TIME002"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        is_over = (
            bool(observation.now_ns)
            and observation.is_simulated
            and not observation.nodes_of("/clock")
        )
        if is_over and observation.symptom("Time") and not observation.is_recorded:
            yield self.found(
                f"Simulated time has stopped at {observation.now_ns / 1e9:.1f} s: no node "
                "publishes /clock.",
                "Start the simulator or the playback of the bag again.",
                evidence={"time_s": observation.now_ns / 1e9},
                command="ros2 topic info /clock --verbose",
                explains=observation.stalled(),
                causes=CauseLevel.GRAPH,
            )
