"""Messages without a stamp."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

FEWEST = 3
"""Messages; a single one, such as a map, is of no moment."""


class ZeroStamps(Check):
    """Stamps of zero.

    All messages on a topic have the stamp 0.

    Why:
        For tf2 the stamp 0 means the newest transform, so that data of a moving robot is drawn
        where the robot is now, not where it was.

    Repair:
        Set `header.stamp` where the message is made.
    """

    id = "TIME006"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for display, each in observation.inputs():
            if len(each.stamps) >= FEWEST and not any(stamp_ns for stamp_ns, _ in each.stamps):
                nodes = observation.nodes_of(each.topic)
                yield self.found(
                    f"The messages on {each.topic} have no stamp.",
                    f"Set header.stamp in {nodes or 'its publisher'}.",
                    subject=each.topic,
                    evidence={"topic": each.topic, "messages": len(each.stamps)},
                    command=f"ros2 topic echo --field header {each.topic}",
                    explains=display.symptom("Transform"),
                )
