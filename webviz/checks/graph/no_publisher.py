"""Topics without a publisher."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import ChangeDisplay, Finding
from webviz.api.observation import Observation
from webviz.api.status import Remedy
from webviz.checks.graph.names import suggested
from webviz.data.words import joined


class NoPublisher(Check):
    """Topic without a publisher.

    A display subscribes to a topic that no node publishes, and no topic of its type has a similar
    name.

    Why:
        A subscription without a publisher is valid in ROS: it waits, and nothing reports an error.

    Repair:
        Start the node that publishes the topic, or choose another topic in the display. Print the
        topics of a type with

            ros2 topic find sensor_msgs/msg/LaserScan
    """

    id = "GRAPH010"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic without a publisher."""
        for display, each, offer in seen.starved():
            if offer.publishers or offer.problem or each.received or suggested(display, each):
                continue
            status = display.problem(each.status)
            remedy = status and status.remedy
            hiding = seen.environment.local_only if seen.environment else ""
            place = "The bag has no messages on" if seen.is_recorded else "No node publishes"
            yield self.found(
                f"{place} {each.topic}.",
                "Choose another topic."
                if seen.is_recorded
                else joined(
                    "Start the node that publishes it, or choose another topic.",
                    hiding and f"With {hiding}, those of other machines are not found.",
                ),
                subject=each.topic,
                evidence={"topic": each.topic, "types": each.types},
                command=f"ros2 topic find {each.types[0]}",
                button=ChangeDisplay(display.id, remedy) if isinstance(remedy, Remedy) else None,
                explains=display.symptom(each.status),
            )
