"""Simulated time that webviz does not follow."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import NO_OFFER, Observation
from webviz.checks.time.clock_stands import STILL_S
from webviz.data.transforms.reasons import WALL_NS, YEAR_NS


class SimulatedData(Check):
    """Simulated data and wall time.

    Data is stamped with simulated time, and webviz follows the clock of this computer.

    Why:
        Ages and delays are meaningless then, and nothing that has stopped is noticed.

    Repair:
        Start webviz with simulated time:

            webviz --ros-args -p use_sim_time:=true
    """

    id = "TIME004"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        if observation.is_simulated or observation.is_recorded or observation.now_ns < WALL_NS:
            return
        if len(observation.offers.get("/clock", NO_OFFER).publishers) > 1:
            return  # following one of two clocks would not help: TIME003
        if observation.clock is not None and observation.clock.still_s >= STILL_S:
            return  # nor one that stands: TIME013
        for display, each in observation.inputs():
            stamp_ns = each.stamps[-1][0] if each.stamps else 0
            if 0 < stamp_ns < YEAR_NS:
                yield self.found(
                    f"{each.topic} is stamped with simulated time, {stamp_ns / 1e9:.1f} s, but "
                    "webviz follows the clock of this computer.",
                    "Start webviz with use_sim_time.",
                    subject=each.topic,
                    evidence={"topic": each.topic, "stamp_s": stamp_ns / 1e9},
                    command="webviz --ros-args -p use_sim_time:=true",
                    explains=(*display.symptom("Transform"), *observation.symptom("Clocks")),
                )
