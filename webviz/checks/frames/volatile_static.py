"""Static transforms that late nodes do not receive."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


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

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each node that publishes static transforms as volatile."""
        offer = seen.offers.get("/tf_static")
        if offer is None or offer.is_recorded:
            return
        for publisher in offer.publishers:
            if publisher.durability == "volatile" and publisher.is_qos_known:
                yield self.found(
                    f"{publisher.label} publishes /tf_static as volatile, so nodes that start "
                    "later miss its transforms.",
                    "Publish with transient local durability.",
                    subject=publisher.label,
                    evidence={"node": publisher.label, "durability": publisher.durability},
                    command="ros2 topic info /tf_static --verbose",
                )
