"""A ROS node that publishes messages of any type, for tests."""

from __future__ import annotations

from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import serialize_message
from rclpy.signals import SignalHandlerOptions

from webviz.ros.types import message_class

DEPTH = 100


class PublisherNode:
    """A node with reliable publishers."""

    def __init__(self, name: str, domain_id: int) -> None:
        self._context = Context()
        rclpy.init(
            context=self._context,
            domain_id=domain_id,
            signal_handler_options=SignalHandlerOptions.NO,
        )
        self._node = Node(name, context=self._context, start_parameter_services=False)
        self._publishers: dict[str, Publisher] = {}

    @property
    def name(self) -> str:
        """Full name of the node."""
        return self._node.get_fully_qualified_name()

    def open(self, topic: str, type_name: str, latched: bool) -> Publisher:
        """Return the publisher of a topic, created on first use."""
        if topic not in self._publishers:
            durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
            qos = QoSProfile(depth=DEPTH, durability=durability)
            self._publishers[topic] = self._node.create_publisher(
                message_class(type_name), topic, qos
            )
        return self._publishers[topic]

    def close(self) -> None:
        """Destroy the node."""
        self._node.destroy_node()
        self._context.try_shutdown()


def serialize(message: Any) -> tuple[str, bytes]:
    """Type name and CDR bytes of a ROS message object.

    Raises:
        TypeError: `message` is not a ROS message.
    """
    cls = type(message)
    package, _, _ = cls.__module__.partition(".")
    if not hasattr(cls, "get_fields_and_field_types"):
        raise TypeError(
            f"{cls.__name__} is not a ROS message. Publish one, or a type name and values."
        )
    return f"{package}/msg/{cls.__name__}", serialize_message(message)
