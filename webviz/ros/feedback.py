"""Subscriptions of the node to the feedback of actions."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

from webviz.ros.distribution import publisher_count
from webviz.ros.types import message_class

FEEDBACK_DEPTH = 10


class FeedbackSubscriptions:
    """One subscription for the feedback of all goals of an action.

    Args:
        node: that has them.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._subscriptions: dict[str, Subscription] = {}

    def listen(self, topic: str, type: str, arrive: Callable[[bytes], None]) -> Callable[[], bool]:
        """See `webviz.sources.goals.ListenToFeedback`."""
        if topic not in self._subscriptions:
            self._subscriptions[topic] = self._node.create_subscription(
                message_class(type), topic, arrive, QoSProfile(depth=FEEDBACK_DEPTH), raw=True
            )
        subscription = self._subscriptions[topic]
        return lambda: publisher_count(self._node, subscription) > 0
