"""The publishers of the node."""

from __future__ import annotations

import contextlib
from collections.abc import Collection

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from webviz.ros.qos import NO_EVENTS_OF_PUBLISHERS
from webviz.ros.types import MessageTypeError, message_class
from webviz.sources.graph import Advertisement

MAX_PUBLISHERS = 100


class AdvertisedPublishers:
    """Publishers by advertisement, made when needed; all calls come from the node's thread.

    Args:
        node: that has them.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publishers: dict[Advertisement, Publisher] = {}
        self._advertised: frozenset[Advertisement] = frozenset()

    def advertise(self, advertisements: Collection[Advertisement]) -> None:
        """Create these ahead of their first messages, and destroy the ones advertised before."""
        before, self._advertised = self._advertised, frozenset(advertisements)
        for advertisement in before - self._advertised:
            self._destroy(advertisement)
        for advertisement in self._advertised:
            with contextlib.suppress(MessageTypeError):  # reported by `publish`
                self._find(advertisement)

    def publish(self, advertisement: Advertisement, cdr: bytes) -> int:
        """Publish a message; the number of matched subscriptions."""
        publisher = self._find(advertisement)
        publisher.publish(cdr)
        return publisher.get_subscription_count()

    def _find(self, advertisement: Advertisement) -> Publisher:
        if advertisement not in self._publishers:
            for _ in range(len(self._publishers) - MAX_PUBLISHERS + 1):
                self._destroy(next(iter(self._publishers)))
            profile = QoSProfile(
                depth=advertisement.depth,
                reliability=ReliabilityPolicy[advertisement.reliability.upper()],
                durability=DurabilityPolicy[advertisement.durability.upper()],
            )
            self._publishers[advertisement] = self._node.create_publisher(
                message_class(advertisement.type),
                advertisement.topic,
                profile,
                event_callbacks=NO_EVENTS_OF_PUBLISHERS,
            )
        return self._publishers[advertisement]

    def _destroy(self, advertisement: Advertisement) -> None:
        if publisher := self._publishers.pop(advertisement, None):
            self._node.destroy_publisher(publisher)
