"""Which QoS to ask for: what the publishers offer, unless the user chose."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from webviz.engine.sources import Publisher, Subscription

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
"""Messages that DDS holds for us between two looks, by type; sensors have 5."""
SENSOR_DEPTH = 5


def adapt(wish: Subscription, publishers: Sequence[Publisher]) -> tuple[Reliability, Durability]:
    """The QoS that connects to the most publishers.

    Reliable only if all are, transient local only if all are (rosbag2's rule); best effort and
    volatile connects to everybody while nobody is known.
    """
    matching = [p for p in publishers if p.type == wish.type]
    reliability = wish.topic.reliability
    if reliability == "auto":
        everybody = matching and all(p.reliability == "reliable" for p in matching)
        reliability = "reliable" if everybody else "best_effort"
    durability = wish.topic.durability
    if wish.latched:
        durability = "transient_local"
    elif durability == "auto":
        everybody = matching and all(p.durability == "transient_local" for p in matching)
        durability = "transient_local" if everybody else "volatile"
    return reliability, durability


def is_mixed(wish: Subscription, publishers: Sequence[Publisher]) -> bool:
    """Whether only some publishers latch, so that one subscription cannot serve all of them.

    A volatile one misses what was latched; a transient local one refuses the volatile publishers.
    """
    if wish.topic.durability != "auto" and not wish.latched:
        return False
    offered = {p.durability for p in publishers if p.type == wish.type}
    return len(offered) == 2


def profile(wish: Subscription, reliability: Reliability, durability: Durability) -> QoSProfile:
    """The rclpy profile for a wish and its adapted policies."""
    return QoSProfile(
        depth=wish.topic.depth or DEPTHS.get(wish.type, SENSOR_DEPTH),
        history=HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy.RELIABLE
        if reliability == "reliable"
        else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL
        if durability == "transient_local"
        else DurabilityPolicy.VOLATILE,
    )
