"""Stamps in the past."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import HOUR_NS, in_words

FEWEST, FAR_NS = 5, 1_500_000_000


class OldStamps(Check):
    """Stamps in the past.

    Messages arrive long after the time of their stamp.

    Why:
        The clock of their machine is slow, or a node or the network holds them up. Everything is
        drawn late, and transforms of that time may be gone.

    Repair:
        Compare the clocks of the machines; if they agree, look for the node that delays the data:

            ros2 topic delay /scan
    """

    id = "TIME009"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        if seen.symptom("Clocks"):
            return  # the clock of the transforms is off, too: TIME010
        for display, each in seen.inputs():
            delays = [received_ns - stamp_ns for stamp_ns, received_ns in each.stamps if stamp_ns]
            if len(delays) < FEWEST or not (
                all(FAR_NS < d < HOUR_NS for d in delays) and each.rate_hz > 1.0
            ):
                continue
            usual_ns = sorted(delays)[len(delays) // 2]
            yield self.found(
                f"The stamps of {each.topic} are {in_words(usual_ns)} behind this computer.",
                "Synchronise the clocks of the machines, and look for what delays the data.",
                subject=each.topic,
                evidence={"topic": each.topic, "delay_s": usual_ns / 1e9},
                command=f"ros2 topic delay {each.topic}",
                explains=(*display.symptom("Transform"), *display.symptom("Map")),
            )
