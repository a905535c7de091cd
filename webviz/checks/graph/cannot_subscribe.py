"""Topics whose messages cannot be subscribed to."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.words import joined


class CannotSubscribe(Check):
    """Topic that cannot be subscribed to.

    ROS refuses the subscription, usually because the message type is not installed here and its
    definition is unknown, or because a message exceeds the limit.

    Why:
        Messages do not describe themselves: without the definition of the type, their bytes have no
        meaning.

    Repair:
        Install the package of the message type on this machine, and source its workspace before
        webviz is started:

            ros2 interface show my_msgs/msg/Custom
    """

    id = "GRAPH007"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic with a problem."""
        for display, each, offer in observation.starved():
            if not offer.problem:
                continue
            package = offer.type.partition("/")[0]
            yield self.found(
                f"{each.topic} cannot be read: {offer.problem.rstrip('.')}.",
                joined(f"Install {package}" if package else "", "Source its workspace.")
                if "limit" not in offer.problem
                else "Publish smaller messages.",
                subject=each.topic,
                severity=Severity.ERROR,
                evidence={"topic": each.topic, "type": offer.type, "problem": offer.problem},
                explains=display.symptom(each.status),
            )
