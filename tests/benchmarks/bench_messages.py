"""Speed of decoding, next to rosbags and rclpy on the same bytes in the same run.

    python tests/benchmarks/bench_messages.py

Microseconds depend on the machine and the hour; the ratios are what to compare. rclpy's column is
empty where it, or the message's package, is not installed; its /tf is 50 TransformStamped one by
one, which is what a TFMessage costs it.
"""

from __future__ import annotations

import timeit
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_typestore

from webviz.data.messages import decode
from webviz.data.transforms import TransformBuffer

STORE = get_typestore(Stores.ROS2_JAZZY)
ROUNDS = 7
TRANSFORMS = 50


def new(name: str, *values: Any) -> Any:
    """A rosbags message by its short name."""
    (found,) = [t for t in STORE.types if t.rpartition("/")[2] == name and "type_desc" not in t]
    return STORE.types[found](*values)


def samples() -> Iterator[tuple[str, str, Any]]:
    """Label, type and message of what robots send."""
    header = new("Header", new("Time", 1_700_000_000, 5), "base_link")
    pose = new("Pose", new("Point", 1.0, 2.0, 3.0), new("Quaternion", 0.0, 0.0, 0.0, 1.0))
    covariance = np.zeros(36)
    vector = new("Vector3", 1.0, 2.0, 3.0)
    zero_to_one = np.linspace(0, 1, 720, dtype=np.float32)
    scan = new("LaserScan", header, *[0.5] * 7, zero_to_one, zero_to_one)
    yield "LaserScan 720", "sensor_msgs/msg/LaserScan", scan
    field = new("PointField", "x", 0, 7, 1)
    points = np.zeros(1_600_000, np.uint8)
    cloud = new("PointCloud2", header, 1, 100_000, [field] * 4, False, 16, 0, points, True)
    yield "PointCloud2 100k", "sensor_msgs/msg/PointCloud2", cloud
    info = new("MapMetaData", header.stamp, 0.05, 1000, 1000, pose)
    grid = new("OccupancyGrid", header, info, np.zeros(1_000_000, np.int8))
    yield "OccupancyGrid 1000 x 1000", "nav_msgs/msg/OccupancyGrid", grid
    twist = new("TwistWithCovariance", new("Twist", vector, vector), covariance)
    odometry = new("Odometry", header, "base", new("PoseWithCovariance", pose, covariance), twist)
    yield "Odometry", "nav_msgs/msg/Odometry", odometry
    joints = new("JointState", header, [f"joint_{i}" for i in range(12)], *[np.zeros(12)] * 3)
    yield "JointState 12", "sensor_msgs/msg/JointState", joints
    path = new("Path", header, [new("PoseStamped", header, pose)] * 500)
    yield "Path 500", "nav_msgs/msg/Path", path
    yield "PoseArray 500", "geometry_msgs/msg/PoseArray", new("PoseArray", header, [pose] * 500)
    color = new("ColorRGBA", 1.0, 0.0, 0.0, 1.0)
    image = new("CompressedImage", header, "", np.zeros(0, np.uint8))
    mesh = new("MeshFile", "", np.zeros(0, np.uint8))
    lifetime = new("Duration", 0, 0)
    marker = new(
        *("Marker", header, "bench", 0, 0, 0, pose, vector, color, lifetime, False),
        *([pose.position] * 10, [color] * 10, "", image, [], "", "", mesh, False),
    )
    yield (
        "MarkerArray 100",
        "visualization_msgs/msg/MarkerArray",
        new("MarkerArray", [marker] * 100),
    )
    yield f"TFMessage {TRANSFORMS}", "tf2_msgs/msg/TFMessage", new("TFMessage", transforms())


def transforms() -> list[Any]:
    """The links of a long chain at one time."""
    header = [new("Header", new("Time", 1, 0), f"link_{i}") for i in range(TRANSFORMS + 1)]
    pose = new("Transform", new("Vector3", 1.0, 2.0, 3.0), new("Quaternion", 0.0, 0.0, 0.6, 0.8))
    return [
        new("TransformStamped", header[i], header[i + 1].frame_id, pose) for i in range(TRANSFORMS)
    ]


def with_rclpy(type_name: str, cdr: bytes) -> Callable[[], Any] | None:
    """Decode as rclpy does in a subscription that is not raw; None where it cannot."""
    parts = [(type_name, cdr)]
    if type_name == "tf2_msgs/msg/TFMessage":
        stamped = "geometry_msgs/msg/TransformStamped"
        parts = [(stamped, bytes(STORE.serialize_cdr(t, stamped))) for t in transforms()]
    try:
        deserialize = import_module("rclpy.serialization").deserialize_message
        package, _, name = parts[0][0].split("/")
        kind = getattr(import_module(f"{package}.msg"), name)
    except ImportError:
        return None
    return lambda: [deserialize(part, kind) for _, part in parts]


def ingest(cdr: bytes) -> Callable[[], None]:
    """Decode a TFMessage and insert it, each time with later stamps, as on a robot."""
    buffer = TransformBuffer()
    stamp_ns = 0

    def run() -> None:
        nonlocal stamp_ns
        stamp_ns += 10_000_000
        for link in decode("tf2_msgs/msg/TFMessage", cdr).transforms:
            parent, child, _, translation, rotation = link
            buffer.set_transform(parent, child, stamp_ns, translation, rotation)

    return run


def microseconds(candidates: list[Callable[[], Any] | None]) -> list[float]:
    """Best time of each, measured in turns so that a slow moment hits all."""
    for candidate in filter(None, candidates):
        candidate()  # decoders are built on first use
    calls = [int(0.02 / timeit.timeit(c, number=3) * 3) + 1 if c else 0 for c in candidates]
    best = [float("nan")] * len(candidates)
    for _ in range(ROUNDS):
        for index, (candidate, number) in enumerate(zip(candidates, calls, strict=True)):
            if candidate:
                seconds = timeit.timeit(candidate, number=number) / number
                best[index] = np.fmin(best[index], seconds * 1e6)
    return best


def main() -> None:
    """Print the table."""
    print(f"{'':26}{'webviz':>10}{'rosbags':>10}{'rclpy':>10}   webviz/rosbags  webviz/rclpy")
    for label, type_name, message in samples():
        cdr = bytes(STORE.serialize_cdr(message, type_name))
        rosbags = partial(STORE.deserialize_cdr, cdr, type_name)
        rows: list[tuple[str, Callable[[], Any]]] = [(label, partial(decode, type_name, cdr))]
        if label.startswith("TFMessage"):
            rows.append((f"{label} and insert", ingest(cdr)))
        for row, candidate in rows:
            a, b, c = microseconds([candidate, rosbags, with_rclpy(type_name, cdr)])
            print(f"{row:26}{a:10.1f}{b:10.1f}{c:10.1f}{a / b:17.3f}{a / c:14.3f}")


if __name__ == "__main__":
    main()
