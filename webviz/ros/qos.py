"""The QoS of subscriptions: what the publishers offer, unless the user chose one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from webviz.sources import Publisher, Subscription

Reliability = Literal["reliable", "best_effort"]
Durability = Literal["volatile", "transient_local"]

DEPTHS = {
    "tf2_msgs/msg/TFMessage": 200,
    "std_msgs/msg/String": 1,
    "nav_msgs/msg/OccupancyGrid": 2,
    "map_msgs/msg/OccupancyGridUpdate": 20,
    "nav_msgs/msg/Odometry": 100,
    "visualization_msgs/msg/Marker": 100,
    "visualization_msgs/msg/MarkerArray": 100,
}
"""Default depth of the history by type; other types have `SENSOR_DEPTH`."""
SENSOR_DEPTH = 5


def adapt(
    subscription: Subscription, publishers: Sequence[Publisher]
) -> tuple[Reliability, Durability]:
    """Return the QoS that matches the most publishers.

    As in rosbag2: reliable only if all publishers are, and transient local only if all are. Without
    publishers it is best effort and volatile, which matches any.
    """
    matching = [p for p in publishers if p.type == subscription.type]
    reliability = subscription.topic.reliability
    if reliability == "auto":
        all_reliable = matching and all(p.reliability == "reliable" for p in matching)
        reliability = "reliable" if all_reliable else "best_effort"
    durability = subscription.topic.durability
    if subscription.latched:
        durability = "transient_local"
    elif durability == "auto":
        all_latched = matching and all(p.durability == "transient_local" for p in matching)
        durability = "transient_local" if all_latched else "volatile"
    return reliability, durability


def is_mixed(subscription: Subscription, publishers: Sequence[Publisher]) -> bool:
    """Return whether only some publishers are transient local, so that it takes two subscriptions.

    A volatile one misses latched messages, a transient local one does not match the others.
    """
    if subscription.topic.durability != "auto" and not subscription.latched:
        return False
    offered = {p.durability for p in publishers if p.type == subscription.type}
    return len(offered) == 2


def profile(
    subscription: Subscription, reliability: Reliability, durability: Durability
) -> QoSProfile:
    """Return the rclpy profile for a subscription and its adapted policies."""
    return QoSProfile(
        depth=subscription.topic.depth or DEPTHS.get(subscription.type, SENSOR_DEPTH),
        history=HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy[reliability.upper()],
        durability=DurabilityPolicy[durability.upper()],
    )
