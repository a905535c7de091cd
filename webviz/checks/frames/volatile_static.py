"""Static transforms that late nodes do not receive."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import CauseLevel, Finding
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class VolatileStatic(Check):
    """Static transforms that are not latched.

    A node publishes /tf_static as volatile.

    Why:
        Static transforms are sent once. Nodes that start later, webviz among them, receive them
        only from a transient local publisher.

    Repair:
        Use tf2_ros.StaticTransformBroadcaster, or publish with transient local durability.
    """

    id = "TF024"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each node that publishes static transforms as volatile."""
        offer = observation.offers.get("/tf_static")
        if offer is None or offer.is_recorded:
            return
        kinds = Kind.NO_TRANSFORMS, Kind.UNKNOWN_FIXED_FRAME, Kind.UNKNOWN_FRAME, Kind.NOT_CONNECTED
        symptoms = tuple(
            symptom for symptom, reason in observation.unplaced(*kinds) if not reason.near
        )
        links = map(observation.buffer.link, observation.buffer.frames())
        explains = () if any(link and link.is_static for link in links) else symptoms
        for publisher in offer.publishers:
            if publisher.durability == "volatile" and publisher.is_qos_known:
                yield self.found(
                    f"{publisher.label} publishes /tf_static as volatile, so nodes that start "
                    "later miss its transforms.",
                    "Publish with transient local durability.",
                    subject=publisher.label,
                    evidence={"node": publisher.label, "durability": publisher.durability},
                    command="ros2 topic info /tf_static --verbose",
                    explains=explains,
                    causes=CauseLevel.FRAMES,
                )
