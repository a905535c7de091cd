"""rclpy subscriptions that give whole messages, for types without a Python package too."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from importlib import import_module
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from webviz.data.messages import definitions
from webviz.ros.types import message_class

STORE = get_typestore(Stores.ROS2_JAZZY)
UPDATE = "map_msgs/msg/OccupancyGridUpdate"
STORE.register(get_types_from_msg(definitions.text(UPDATE), UPDATE))


def subscribe(
    node: Node, topic: str, kind: str, callback: Callable[[str, Any], None], qos: QoSProfile | int
) -> None:
    """Call `callback(topic, message)` for each message.

    tf2_msgs and map_msgs are not on PyPI. Where such a package is missing the message comes raw and
    rosbags decodes it, which takes about as long as rclpy's own conversion.
    """
    package, _, name = kind.split("/")
    try:
        installed = getattr(import_module(f"{package}.msg"), name)
    except ModuleNotFoundError:

        def decode(cdr: bytes) -> None:
            callback(topic, STORE.deserialize_cdr(cdr, kind))

        node.create_subscription(message_class(kind), topic, decode, qos, raw=True)
    else:
        node.create_subscription(installed, topic, partial(callback, topic), qos)
