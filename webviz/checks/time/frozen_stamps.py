"""Stamps that stand still."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

FEWEST, LEAST_NS = 5, 1_000_000_000


class FrozenStamps(Check):
    """Stamps that stand still.

    Messages keep arriving on a topic, all with the same stamp.

    Why:
        The driver repeats an old measurement, or its clock stands still. What is drawn stays where
        the robot was.

    Repair:
        Restart the driver, and check that it stamps each message anew.
    """

    id = "TIME007"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for display, each in observation.inputs():
            stamps = {stamp_ns for stamp_ns, _ in each.stamps}
            span_ns = each.stamps[-1][1] - each.stamps[0][1] if each.stamps else 0
            if (
                len(each.stamps) >= FEWEST
                and len(stamps) == 1
                and span_ns > LEAST_NS
                and stamps != {0}
            ):
                yield self.found(
                    f"All messages on {each.topic} have the same stamp.",
                    f"Restart {observation.nodes_of(each.topic) or 'its publisher'}.",
                    subject=each.topic,
                    evidence={"topic": each.topic, "stamp_s": each.stamps[-1][0] / 1e9},
                    command=f"ros2 topic echo --field header.stamp {each.topic}",
                    explains=display.symptom("Transform"),
                )
