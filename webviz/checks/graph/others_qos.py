"""Subscriptions of other nodes that ask for more than is offered."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.api.offer import Endpoint, Offer, Publisher
from webviz.data.words import listed
from webviz.sources.names import is_own

NAMED = 4
Policies = tuple[str, ...]
REMEDIES = {
    "reliable": "subscribe with best effort (qos_profile_sensor_data)",
    "transient_local": "subscribe as volatile",
}
OFFERED = {"reliable": "best effort", "transient_local": "volatile"}


class OthersQos(Check):
    """QoS of two other nodes does not match.

    A node subscribes to a topic with a reliability or durability that its publisher does not offer.
    It is a note if another publisher of the topic does.

    Why:
        DDS connects a reliable subscription only to a reliable publisher, and a transient local one
        only to a transient local publisher. The node receives nothing, and only its log has a line
        about it; webviz, which follows the publisher, shows the topic. Subscriptions are reliable
        by default, and sensor drivers usually publish best effort.

    Repair:
        Subscribe with the QoS of the publisher, such as `qos_profile_sensor_data` for sensors.
        Print both with

            ros2 topic info --verbose /scan
    """

    id = "GRAPH016"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic with such subscriptions."""
        for topic, offer in observation.offers.items():
            if offer.is_recorded:
                continue
            pairs = _mismatches(offer)
            for lacking in dict.fromkeys(lacking for _, _, lacking in pairs):
                alike = [pair for pair in pairs if pair[2] == lacking]
                readers = listed([reader.label for reader, _, _ in alike], NAMED)
                writers = listed([writer.label for _, writer, _ in alike], NAMED)
                starving = [reader for reader, _, _ in alike if not _is_served(reader, offer)]
                policies = " and ".join(lacking).replace("_", " ")
                offered = " and ".join(OFFERED[policy] for policy in lacking)
                remedy = " and ".join(REMEDIES[policy] for policy in lacking)
                yield self.found(
                    f"{readers} cannot receive {topic} from {writers}: requested {policies}, "
                    f"offered {offered}.",
                    f"Let {readers} {remedy}, or let {writers} publish as {policies}.",
                    subject=topic if lacking == pairs[0][2] else f"{topic} as {policies}",
                    severity=Severity.WARNING if starving else Severity.NOTE,
                    evidence={
                        "topic": topic,
                        "subscribers": readers,
                        "publishers": writers,
                        "requested": lacking,
                    },
                    command=f"ros2 topic info --verbose {topic}",
                )


def _mismatches(offer: Offer) -> Sequence[tuple[Endpoint, Publisher, Policies]]:
    """Return subscriptions and publishers that DDS does not connect, with what is not offered.

    Those of webviz have checks of their own.
    """
    return [
        (reader, writer, lacking)
        for reader in offer.readers
        if not is_own(reader.node)
        for writer in offer.publishers
        if writer.type == reader.type and (lacking := _lacking(reader, writer))
    ]


def _lacking(reader: Endpoint, writer: Publisher) -> Policies:
    """Return the policies that a subscription asks for and a publisher does not offer."""
    if not (reader.is_qos_known and writer.is_qos_known):
        return ()
    policies = (reader.reliability, writer.reliability), (reader.durability, writer.durability)
    return tuple(ours for ours, theirs in policies if ours in OFFERED and ours != theirs)


def _is_served(reader: Endpoint, offer: Offer) -> bool:
    """Return whether any publisher matches a subscription."""
    return any(p.type == reader.type and not _lacking(reader, p) for p in offer.publishers)
