"""Stamps in the future."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.checks.time.offsets import FEWEST, LARGE_NS, delays_of, off_alone
from webviz.data.transforms.reasons import HOUR_NS, in_words


class FutureStamps(Check):
    """Stamps in the future.

    Messages arrive before the time of their stamp. Of sensors, a steady third of a second is
    enough, while others are on time.

    Why:
        Transforms for that time do not exist yet, so that the data waits for them.

    Repair:
        Synchronise the clocks of the machines:

            chronyc tracking
    """

    id = "TIME008"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        if observation.symptom("Clocks"):
            return  # the clock of the transforms is off, too: TIME010
        steady = off_alone(observation)
        for display, each in observation.inputs():
            delays = delays_of(each)
            is_far = len(delays) >= FEWEST and all(LARGE_NS < -d < HOUR_NS for d in delays)
            if not is_far and steady.get(each.topic, 0) >= 0:
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
