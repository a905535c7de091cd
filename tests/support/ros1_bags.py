"""ROS 1 bags with real messages."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

SECOND = 1_000_000_000
STORE = get_typestore(Stores.ROS1_NOETIC)
STORE.register(
    get_types_from_msg(
        "Header header\nBasket[] baskets\nduration ripe\n"
        f"{'=' * 80}\nMSG: fruit_of_ros_1/Basket\nstring name\nint16[2] size\nbool is_full",
        "fruit_of_ros_1/msg/Harvest",
    )
)
TF = "geometry_msgs/TransformStamped[] transforms"
STORE.register(get_types_from_msg(TF, "tf2_msgs/msg/TFMessage"))
T = STORE.types


def time(at_s: float) -> Any:
    return T["builtin_interfaces/msg/Time"](1000 + int(at_s), round(at_s % 1 * 1e9))


def head(frame: str, at_s: float) -> Any:
    return T["std_msgs/msg/Header"](7, time(at_s), frame)


def ros1_transform(parent: str, child: str, at_s: float, x: float) -> Any:
    vector = T["geometry_msgs/msg/Vector3"](x, 0.0, 0.0)
    turned = T["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
    transform = T["geometry_msgs/msg/Transform"](vector, turned)
    return T["geometry_msgs/msg/TransformStamped"](head(parent, at_s), child, transform)


def scan(at_s: float) -> Any:
    ranges, none = np.array([1, 2, 3 + at_s], np.float32), np.zeros(0, np.float32)
    name = "sensor_msgs/msg/LaserScan"
    return T[name](head("laser", at_s), 0.0, 0.2, 0.1, 0.0, 0.1, 0.0, 9.0, ranges, none)


def camera() -> Any:
    roi = T["sensor_msgs/msg/RegionOfInterest"](0, 0, 0, 0, False)
    k, p = np.arange(9.0), np.arange(12.0)
    name = "sensor_msgs/msg/CameraInfo"
    return T[name](head("lens", 0), 4, 6, "plumb_bob", np.zeros(5), k, k, p, 0, 0, roi)


def harvest() -> Any:
    basket = T["fruit_of_ros_1/msg/Basket"]("pears", np.array([3, -4], np.int16), True)
    ripe = T["builtin_interfaces/msg/Duration"](-2, 5)
    return T["fruit_of_ros_1/msg/Harvest"](head("tree", 1), [basket, basket], ripe)


def written(
    path: Path,
    compression: Writer.CompressionFormat | None = None,
    seconds: int = 10,
    chunk_bytes: int = 1 << 20,
) -> Path:
    """Some seconds of a robot with a laser."""
    writer = Writer(path)
    writer.chunk_threshold = chunk_bytes
    if compression:
        writer.set_compression(compression)
    with writer:
        connections: dict[str, Any] = {}

        def put(at_s: float, topic: str, message: Any, latch: int | None = None) -> None:
            name = message.__msgtype__
            if topic not in connections:
                connections[topic] = writer.add_connection(
                    topic, name, typestore=STORE, latching=latch
                )
            raw = STORE.serialize_ros1(message, name)
            writer.write(connections[topic], 1000 * SECOND + round(at_s * 1e9), raw)

        tf = T["tf2_msgs/msg/TFMessage"]
        put(0, "/tf_static", tf([ros1_transform("base", "laser", 0, 0.5)]), 1)
        put(0, "/camera_info", camera())
        put(1, "/harvest", harvest())
        for tenths in range(10 * seconds):
            put(tenths / 10, "/tf", tf([ros1_transform("odom", "base", tenths / 10, tenths / 10)]))
            put(tenths / 10, "/scan", scan(tenths / 10))
    return path
