"""The publishers of the node."""

from __future__ import annotations

import contextlib
from collections.abc import Collection

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from webviz.ros.qos import NO_EVENTS_OF_PUBLISHERS
from webviz.ros.types import MessageTypeError, message_class
from webviz.sources.graph import Outlet

MAX_PUBLISHERS = 100


class OutletPublishers:
    """Publishers by outlet, made when they are needed. All calls come from the node's thread.

    Args:
        node: that has them.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publishers: dict[Outlet, Publisher] = {}
        self._advertised: frozenset[Outlet] = frozenset()

    def advertise(self, outlets: Collection[Outlet]) -> None:
        """Create these ahead of their first messages, and destroy the ones advertised before."""
        before, self._advertised = self._advertised, frozenset(outlets)
        for outlet in before - self._advertised:
            self._destroy(outlet)
        for outlet in self._advertised:
            with contextlib.suppress(MessageTypeError):  # reported by `publish`
                self._find(outlet)

    def publish(self, outlet: Outlet, cdr: bytes) -> int:
        """Publish a message; the number of matched subscriptions."""
        publisher = self._find(outlet)
        publisher.publish(cdr)
        return publisher.get_subscription_count()

    def _find(self, outlet: Outlet) -> Publisher:
        if outlet not in self._publishers:
            for _ in range(len(self._publishers) - MAX_PUBLISHERS + 1):
                self._destroy(next(iter(self._publishers)))
            profile = QoSProfile(
                depth=outlet.depth,
                reliability=ReliabilityPolicy[outlet.reliability.upper()],
                durability=DurabilityPolicy[outlet.durability.upper()],
            )
            self._publishers[outlet] = self._node.create_publisher(
                message_class(outlet.type),
                outlet.topic,
                profile,
                event_callbacks=NO_EVENTS_OF_PUBLISHERS,
            )
        return self._publishers[outlet]

    def _destroy(self, outlet: Outlet) -> None:
        if publisher := self._publishers.pop(outlet, None):
            self._node.destroy_publisher(publisher)
