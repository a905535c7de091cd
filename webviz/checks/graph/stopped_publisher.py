"""Topics on which messages no longer arrive."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import DisplaySeen, InputSeen, Observation
from webviz.checks.graph.silent_publisher import MAP, STREAMS
from webviz.data.words import listed

NAMED = 4
TOGETHER_S = 1.0
ON_CHANGE = MAP
"""Some mappers publish only while the robot moves."""


class StoppedPublisher(Check):
    """Messages that no longer arrive.

    Messages arrived at a steady rate, and then no more, although the publisher still exists. Of
    maps, paths, poses of localisation and others that are only sent while the robot moves, it is a
    note.

    Why:
        The node hangs, its sensor has failed, or the link to its machine has been lost: DDS notices
        a lost machine only after its lease of about 20 s.

    Repair:
        Look at the log of the node and at the sensor. Check whether its machine still answers.
    """

    id = "GRAPH009"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that fell silent; those that did so together are one."""
        stopped = [
            (display, each)
            for display, each, offer in observation.starved()
            if each.received and offer.publishers and not offer.problem
        ]
        for together in (
            [[one] for one in stopped] if observation.is_recorded else _together(stopped)
        ):
            _, each = together[0]
            topics = list(dict.fromkeys(each.topic for _, each in together))
            named = listed(topics, NAMED)
            who = listed([*dict.fromkeys(map(observation.nodes_of, topics))], NAMED)
            rate = f", previously at {each.rate_hz:.1f} Hz" if len(topics) == 1 else ""
            yield self.found(
                f"{each.topic} stops in the bag; its rate was {each.rate_hz:.1f} Hz."
                if observation.is_recorded
                else f"Nothing has arrived on {named} from {who} for {each.silence}{rate}.",
                "Look at the log of the node and at its sensor."
                if observation.is_recorded
                else "Check the log of the node, its sensor, and the link to its machine.",
                subject=each.topic,
                severity=Severity.WARNING
                if any(one.type in STREAMS - {ON_CHANGE} for _, one in together)
                else Severity.NOTE,
                evidence={
                    "topics": tuple(topics),
                    "rate_hz": round(each.rate_hz, 3),
                    "received": each.received,
                },
                command=f"ros2 topic hz {each.topic}",
                explains=tuple(
                    symptom
                    for display, one in together
                    for symptom in (*display.symptom(one.status), *observation.outlived(display))
                ),
            )


def _together(
    stopped: Sequence[tuple[DisplaySeen, InputSeen]],
) -> Iterator[list[tuple[DisplaySeen, InputSeen]]]:
    """Yield topics that stopped at the same time, by name, as those of a machine that was lost."""
    group: list[tuple[DisplaySeen, InputSeen]] = []
    for each in sorted(stopped, key=lambda each: each[1].silent_s):
        if group and each[1].silent_s - group[0][1].silent_s > TOGETHER_S:
            yield sorted(group, key=_topic)
            group = []
        group.append(each)
    if group:
        yield sorted(group, key=_topic)


def _topic(each: tuple[DisplaySeen, InputSeen]) -> str:
    return each[1].topic
