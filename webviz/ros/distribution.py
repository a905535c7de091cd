"""Differences between the distributions of ROS 2, from Humble to Lyrical, in what rclpy offers.

Other modules use what all of them have, and never ask which one it is. On the wire of DDS, names,
topics, services, actions and parameters are the same in all of them: Humble announces no type
hashes, but DDS matches without them. Fields of messages that differ are the concern of
`webviz.data.messages.distributions`.
"""

from __future__ import annotations

import os
from importlib import metadata
from typing import TYPE_CHECKING

from rclpy.client import Client
from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.subscription import Subscription

if TYPE_CHECKING:
    from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
else:
    try:
        from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
    except ImportError:  # Humble
        from rclpy.qos_event import PublisherEventCallbacks, SubscriptionEventCallbacks

_BY_VERSION = {3: "humble", 4: "iron", 7: "jazzy", 9: "kilted"}
"""Distributions by the major version of their rclpy."""
_COMPOSABLE = "jazzy", "kilted"

NO_EVENTS_OF_PUBLISHERS = PublisherEventCallbacks(use_default_callbacks=False)
NO_EVENTS_OF_SUBSCRIPTIONS = SubscriptionEventCallbacks(use_default_callbacks=False)
"""Callbacks of whatever is destroyed while the executor runs: an event that waits then, such as
that of an incompatible publisher, ends `spin_once` with an InvalidHandle. The statuses of displays
report what the default events would log."""


def name() -> str:
    """Return the distribution that rclpy belongs to, such as "jazzy"; "" if it is unknown.

    A sourced ROS may be another one than that of an rclpy in a virtual environment.
    """
    major = int(metadata.version("rclpy").partition(".")[0])
    return _BY_VERSION.get(major) or os.environ.get("ROS_DISTRO", "")


def apt_name(package: str) -> str:
    """Return the name with which apt installs a package of ROS, such as "ros-jazzy-std-srvs"."""
    return f"ros-{name() or '<distribution>'}-{package.replace('_', '-')}"


def has_known_type_supports() -> bool:
    """Return whether the C structs of types are those that `webviz.ros.types` composes.

    rosidl's structs and Fast CDR's `Cdr` were others before Jazzy, and have not been tried after
    Kilted. There, types need their packages.
    """
    return name() in _COMPOSABLE


def executor(context: Context | None = None) -> Executor:
    """Return the events executor (20 µs per message) if available, which it is since rclpy 7.1.4.

    The default one rebuilds its wait set on every wake-up, 25 µs per subscription.
    """
    try:
        from rclpy.experimental.events_executor import EventsExecutor
    except ImportError:
        return SingleThreadedExecutor(context=context)
    return EventsExecutor(context=context)  # pyright: ignore[reportReturnType]


def service_name(client: Client) -> str:
    """Return the full name of the service that a client calls."""
    try:
        return client.service_name
    except AttributeError:  # Humble and Iron, whose attribute is not resolved: ours are full names
        return client.srv_name


def publisher_count(node: Node, subscription: Subscription) -> int:
    """Return the number of publishers that match a subscription of a node."""
    try:
        return subscription.get_publisher_count()
    except AttributeError:  # Humble, which knows those of the topic only
        return node.count_publishers(subscription.topic_name)
