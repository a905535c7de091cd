"""Stamps in the past."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.checks.time.offsets import FEWEST, LARGE_NS, delays_of, off_alone
from webviz.data.transforms.reasons import HOUR_NS, in_words

TRANSFORMS = "TIME010"
"""Id of the check of transforms that are late."""


class OldStamps(Check):
    """Stamps in the past.

    Messages arrive long after the time of their stamp. Of sensors, a steady third of a second is
    enough, while others are on time.

    Why:
        The clock of their machine is slow, or a node or the network holds them up. Everything is
        drawn late, and transforms of that time may be gone.

    Repair:
        Compare the clocks of the machines; if they agree, look for the node that delays the data:

            ros2 topic delay /scan
    """

    id = "TIME009"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        if observation.symptom("Clocks"):
            return  # the clock of the transforms is off, too: TIME010
        if any(each.id == TRANSFORMS for each in observation.findings):
            return  # the transforms are late, too
        steady = off_alone(observation)
        for display, each in observation.inputs():
            delays = delays_of(each)
            is_far = len(delays) >= FEWEST and all(LARGE_NS < d < HOUR_NS for d in delays)
            if not (is_far and each.rate_hz > 1.0) and steady.get(each.topic, 0) <= 0:
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
