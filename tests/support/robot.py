"""A robot of a few links and scans whose every stamp a test decides, over DDS."""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile

from webviz.data.messages import encode
from webviz.ros.types import message_class
from webviz.shell.testing.messages import header, stamped_transform
from webviz.shell.testing.source import SECOND

TF = "tf2_msgs/msg/TFMessage"
SCAN = "sensor_msgs/msg/LaserScan"
RATE_HZ = 20


def transforms(*links: tuple[str, str, int, float]) -> Mapping[str, Any]:
    """A TFMessage of (parent, child, stamp in ns, x in metres)."""
    return {
        "transforms": [
            stamped_transform(parent, child, stamp_ns, (x, 0.0, 0.0))
            for parent, child, stamp_ns, x in links
        ]
    }


@dataclass
class Scan:
    """A stream of scans: frame, and how far its stamps are from now in seconds."""

    frame: str
    offset_s: float = 0.0
    stamp_ns: int | None = None
    """A fixed stamp instead."""


@dataclass
class Robot:
    """Publishes links and scans at 20 Hz in a thread, until told otherwise.

    Args:
        domain: ROS domain.
        name: of its node.
    """

    domain: int
    name: str = "robot"
    links: dict[tuple[str, str], float] = field(default_factory=dict)
    """Seconds that the stamps of each (parent, child) are from now."""
    scans: dict[str, Scan] = field(default_factory=dict)
    """Scans by topic."""

    def __post_init__(self) -> None:
        self._context = Context()
        rclpy.init(context=self._context, domain_id=self.domain)
        self.node = Node(self.name, context=self._context)
        self._publishers: dict[str, Publisher] = {}
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def publish(
        self, topic: str, type_name: str, values: Mapping[str, Any], *, latched: bool = False
    ) -> None:
        """Publish one message."""
        if topic not in self._publishers:
            durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
            qos = QoSProfile(depth=1 if latched else 100, durability=durability)
            self._publishers[topic] = self.node.create_publisher(
                message_class(type_name), topic, qos
            )
        self._publishers[topic].publish(encode(type_name, values))

    def scan(self, topic: str, frame: str, stamp_ns: int) -> None:
        """Publish one scan of three points."""
        values = {
            "header": header(frame, stamp_ns),
            "angle_increment": 0.1,
            "range_max": 10.0,
            "ranges": [1.0, 1.0, 1.0],
        }
        self.publish(topic, SCAN, values)

    def static(self, parent: str, child: str, x: float = 0.0) -> None:
        """Latch one static transform."""
        self.publish("/tf_static", TF, transforms((parent, child, time.time_ns(), x)), latched=True)

    def close(self) -> None:
        """Leave the graph."""
        self._stop.set()
        self._thread.join()
        self.node.destroy_node()
        self._context.try_shutdown()

    def _run(self) -> None:
        while not self._stop.wait(1 / RATE_HZ):
            now_ns = time.time_ns()
            links = [
                (parent, child, now_ns + round(offset_s * SECOND), 1.0)
                for (parent, child), offset_s in list(self.links.items())
            ]
            if links:
                self.publish("/tf", TF, transforms(*links))
            for topic, scan in list(self.scans.items()):
                stamp_ns = scan.stamp_ns
                if stamp_ns is None:
                    stamp_ns = now_ns + round(scan.offset_s * SECOND)
                self.scan(topic, scan.frame, stamp_ns)
