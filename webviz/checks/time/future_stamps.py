"""Stamps in the future."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import HOUR_NS, in_words

FEWEST, FAR_NS = 5, 1_500_000_000


class FutureStamps(Check):
    """Stamps in the future.

    Messages arrive before the time of their stamp.

    Why:
        Transforms for that time do not exist yet, so that the data waits for them.

    Repair:
        Synchronise the clocks of the machines:

            chronyc tracking
    """

    id = "TIME008"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        if seen.symptom("Clocks"):
            return  # the clock of the transforms is off, too: TIME010
        for display, each in seen.inputs():
            delays = [received_ns - stamp_ns for stamp_ns, received_ns in each.stamps if stamp_ns]
            if len(delays) < FEWEST or not (all(FAR_NS < -d < HOUR_NS for d in delays)):
                continue
            usual_ns = sorted(delays)[len(delays) // 2]
            yield self.found(
                f"The stamps of {each.topic} are {in_words(usual_ns)} ahead of this computer.",
                "Synchronise the clocks of the machines.",
                subject=each.topic,
                evidence={"topic": each.topic, "delay_s": usual_ns / 1e9},
                command=f"ros2 topic delay {each.topic}",
                explains=display.symptom("Transform"),
            )
