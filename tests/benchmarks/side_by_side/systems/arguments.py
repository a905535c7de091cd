"""Arguments of the systems beside webviz: topics, and which of them are latched."""

from __future__ import annotations

from collections.abc import Sequence

from rclpy.qos import DurabilityPolicy, QoSProfile

_once = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LATCHED: dict[str, QoSProfile] = dict.fromkeys(("/map", "/tf_static", "/robot_description"), _once)


def parsed(topics: Sequence[str]) -> dict[str, str]:
    """Types by topic, of arguments as `/scan=sensor_msgs/msg/LaserScan`."""
    return dict(topic.split("=") for topic in topics)
