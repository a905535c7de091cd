"""Topics without a publisher."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from webviz.api.check import Check
from webviz.api.finding import ChangeDisplay, Finding, HideDisplays
from webviz.api.observation import DisplaySeen, InputSeen, Observation
from webviz.api.status import Remedy
from webviz.checks.graph.names import suggested
from webviz.data.words import joined

LISTED = 4
"""Topics that the sentence names."""


class NoPublisher(Check):
    """Topic without a publisher.

    A display subscribes to a topic that no node publishes, and no topic of its type has a similar
    name. Displays of a bag that lacks their topics are one finding.

    Why:
        A subscription without a publisher is valid in ROS: it waits, and nothing reports an error.

    Repair:
        Start the node that publishes the topic, or choose another topic in the display. Print the
        topics of a type with

            ros2 topic find sensor_msgs/msg/LaserScan
    """

    id = "GRAPH010"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic without a publisher, one for all of a bag."""
        unpublished = [
            (display, each)
            for display, each, offer in observation.starved()
            if not (offer.publishers or offer.problem or each.received or suggested(display, each))
        ]
        if observation.is_recorded and len({display.id for display, _ in unpublished}) > 1:
            yield self._missing(unpublished)
            return
        hiding = observation.environment.local_only if observation.environment else ""
        for display, each in unpublished:
            status = display.problem(each.status)
            remedy = status and status.remedy
            change = ChangeDisplay(display.id, remedy) if isinstance(remedy, Remedy) else None
            place = "The bag has no messages on" if observation.is_recorded else "No node publishes"
            yield self.found(
                f"{place} {each.topic}.",
                "Choose another topic, or hide the display."
                if observation.is_recorded
                else joined(
                    "Start the node that publishes it, or choose another topic.",
                    hiding and f"With {hiding}, those of other machines are not found.",
                ),
                subject=each.topic,
                evidence={"topic": each.topic, "types": each.types},
                command=f"ros2 topic find {each.types[0]}",
                button=change or (HideDisplays((display.id,)) if observation.is_recorded else None),
                explains=display.symptom(each.status),
            )

    def _missing(self, pairs: Sequence[tuple[DisplaySeen, InputSeen]]) -> Finding:
        """Return the one finding for all topics that a bag lacks."""
        ids = tuple(dict.fromkeys(display.id for display, _ in pairs))
        topics = tuple(dict.fromkeys(each.topic for _, each in pairs))
        more = f" and {len(topics) - LISTED} more" if len(topics) > LISTED else ""
        return self.found(
            f"{len(ids)} displays read topics that this bag lacks.",
            "Choose other topics, or hide the displays.",
            proof=f"It has no messages on {', '.join(topics[:LISTED])}{more}.",
            evidence={"topics": topics},
            button=HideDisplays(ids),
            explains=tuple(s for display, each in pairs for s in display.symptom(each.status)),
        )
