"""A robot that is well, each stream of which a provocation can change: over DDS, or in a bag."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import building
from bags import START_NS, Bag

from webviz.data.messages import encode
from webviz.data.rotations import from_rpy
from webviz.shell.testing.messages import header, stamped_transform
from webviz_sim.pose import Pose2D

TF = "tf2_msgs/msg/TFMessage"
SCAN = "sensor_msgs/msg/LaserScan"
ODOMETRY = "nav_msgs/msg/Odometry"
MAP = "nav_msgs/msg/OccupancyGrid"
JOINTS = "sensor_msgs/msg/JointState"
CLOCK = "rosgraph_msgs/msg/Clock"
STRING = "std_msgs/msg/String"

TURN, SPEED = 0.5, 0.3
"""Speeds of the circle that the robot drives, in rad/s and m/s."""
START = Pose2D(-3.5, 1.5)
"""Pose from which the circle keeps 0.6 m from all walls."""
LASER_M = 0.1
"""Distance in metres of the laser before the robot's middle."""
URDF = """<robot name="cart">
<link name="base_link"><visual><geometry><box size="0.3 0.2 0.1"/></geometry></visual></link>
<link name="laser"/><link name="wheel"/>
<joint name="mount" type="fixed"><parent link="base_link"/><child link="laser"/>
<origin xyz="0.1 0 0.2"/></joint>
<joint name="axle" type="continuous"><parent link="base_link"/><child link="wheel"/>
<axis xyz="0 1 0"/></joint>
</robot>"""

Values = dict[str, Any]
Make = Callable[[float, int], Values]
"""Makes a message, from seconds since the start and its stamp in ns."""


@dataclass
class Stream:
    """The messages that a node sends on a topic.

    Args:
        node: its name.
        topic, type: of the messages.
        make: makes one.
        rate_hz: of the messages; 0 for one at the start.
        is_latched, is_reliable: QoS.
        begins_s: seconds since the start.
        ends_s: seconds since webviz subscribed, or in the bag; 0 for never a message.
        ahead_s: of its stamps.
    """

    node: str
    topic: str
    type: str
    make: Make
    rate_hz: float = 10.0
    is_latched: bool = False
    is_reliable: bool = True
    begins_s: float = 0.0
    ends_s: float = math.inf
    ahead_s: float = 0.0

    def then(self, change: Callable[[Values, float], object]) -> None:
        """Change its messages: a function of the message and the seconds since the start."""
        make = self.make

        def changed(at_s: float, stamp_ns: int) -> Values:
            values = make(at_s, stamp_ns)
            change(values, at_s)
            return values

        self.make = changed


@dataclass
class TrialSubscription:
    """A subscription of a node."""

    node: str
    topic: str
    type: str
    is_reliable: bool = True
    is_latched: bool = False
    deadline_s: float = 0.0


@dataclass
class TrialRobot:
    """A robot with a lidar that drives in a circle through the simulator's building."""

    streams: dict[str, Stream] = field(default_factory=lambda: dict(_streams()))
    readers: list[TrialSubscription] = field(default_factory=list)
    actions: list[tuple[float, Callable[[], object]]] = field(default_factory=list)
    """Times of actions in seconds since webviz subscribed."""
    time_ns: Callable[[float], int] | None = None
    """Time of the stamps, from seconds since the start; None is that of this computer."""
    parameters: dict[str, dict[str, Any]] = field(default_factory=dict)
    """Parameters of nodes."""
    namespace: str = ""
    lifecycle: set[str] = field(default_factory=set)
    """Nodes that are lifecycle nodes, and inactive."""
    _leaving: set[str] = field(default_factory=set)

    def __getitem__(self, name: str) -> Stream:
        return self.streams[name]

    def add(self, name: str, like: str, **changes: Any) -> Stream:
        """Add a stream like another."""
        self.streams[name] = replace(self.streams[like], **changes)
        return self.streams[name]

    def link(self, parent: str, child: str, node: str = "other", **changes: Any) -> Stream:
        """Add a stream of a transform."""
        stream = Stream(node, "/tf", TF, _link(parent, child, lambda _: (1.0, 0.0, 0.0)), 20.0)
        self.streams[f"{parent} {child} {node}"] = stream = replace(stream, **changes)
        return stream

    def remove(self, *names: str) -> None:
        """Remove streams."""
        for name in names:
            del self.streams[name]

    def into(self, namespace: str, has_own_transforms: bool = False) -> None:
        """Put all nodes and topics into a namespace, transforms only if they are its own."""
        self.namespace = namespace
        for each in self.streams.values():
            if has_own_transforms or not each.topic.startswith("/tf"):
                each.topic = f"/{namespace}{each.topic}"

    def leave(self, node: str) -> None:
        """Let a node leave the graph."""
        self._leaving.add(node)

    def run(self, started: Path) -> None:
        """Publish over DDS, and write a file once the first messages are out."""
        import rclpy
        from rclpy.duration import Duration
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.lifecycle import LifecycleNode
        from rclpy.node import Node
        from rclpy.parameter import Parameter
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

        from webviz.ros.types import message_class

        def qos(is_reliable: bool, is_latched: bool, deadline_s: float = 0.0) -> QoSProfile:
            return QoSProfile(
                depth=10,
                deadline=Duration(seconds=deadline_s),
                reliability=ReliabilityPolicy.RELIABLE
                if is_reliable
                else ReliabilityPolicy.BEST_EFFORT,
                durability=DurabilityPolicy.TRANSIENT_LOCAL
                if is_latched
                else DurabilityPolicy.VOLATILE,
            )

        rclpy.init()
        executor = SingleThreadedExecutor()
        names = dict.fromkeys(
            [s.node for s in self.streams.values()] + [r.node for r in self.readers]
        )
        nodes: dict[str, Node] = {}
        for name in names:
            kind = LifecycleNode if name in self.lifecycle else Node
            parameters = [
                Parameter(key, value=value) for key, value in self.parameters.get(name, {}).items()
            ]
            nodes[name] = kind(
                name.partition("#")[0], namespace=self.namespace, parameter_overrides=parameters
            )
            executor.add_node(nodes[name])
        for each in self.readers:
            nodes[each.node].create_subscription(
                message_class(each.type),
                each.topic,
                lambda _: None,
                qos(each.is_reliable, each.is_latched, each.deadline_s),
            )
        publishers: dict[tuple[str, str, str], Any] = {}
        for each in self.streams.values():
            key = each.node, each.topic, each.type
            if key not in publishers:
                publishers[key] = nodes[each.node].create_publisher(
                    message_class(each.type), each.topic, qos(each.is_reliable, each.is_latched)
                )
        began, counts = time.monotonic(), dict.fromkeys(self.streams, 0)
        found_s = math.inf
        while True:
            at_s = time.monotonic() - began
            if any(each.get_subscription_count() for each in publishers.values()):
                found_s = min(found_s, at_s)
            watched_s = max(0.0, at_s - found_s)
            now_ns = time.time_ns() if self.time_ns is None else self.time_ns(at_s)
            for name, each in self.streams.items():
                if each.node in self.lifecycle or each.node not in nodes:
                    continue
                if watched_s >= each.ends_s or not _is_due(each, at_s, counts[name]):
                    continue
                counts[name] += 1
                values = each.make(at_s, now_ns + round(each.ahead_s * 1e9))
                publishers[each.node, each.topic, each.type].publish(encode(each.type, values))
            started.touch()
            for due_s, act in [each for each in self.actions if each[0] <= watched_s]:
                self.actions.remove((due_s, act))
                act()
            for node in self._leaving & nodes.keys():
                executor.remove_node(nodes[node])
                nodes.pop(node).destroy_node()
                for key in [key for key in publishers if key[0] == node]:
                    del publishers[key]
            executor.spin_once(timeout_sec=0.01)

    def record(self, path: Path, seconds: float = 8.0) -> Path:
        """Write the bag of some seconds."""
        bag = Bag()
        for each in self.streams.values():
            bag.add(each.topic, each.type, latched=each.is_latched)
            count = max(1, int((min(seconds, each.ends_s) - each.begins_s) * each.rate_hz))
            for number in range(count):
                at_s = each.begins_s + (number / each.rate_hz if each.rate_hz else 0.0)
                time_ns = self.time_ns or (lambda at_s: START_NS + round(at_s * 1e9))
                stamp_ns = time_ns(at_s) + round(each.ahead_s * 1e9)
                bag.put(at_s, each.topic, each.make(at_s, stamp_ns))
        return bag.write_file(path)


def _is_due(stream: Stream, at_s: float, counts: int) -> bool:
    if at_s < stream.begins_s:
        return False
    return (
        counts == 0 if not stream.rate_hz else (at_s - stream.begins_s) * stream.rate_hz >= counts
    )


def pose(at_s: float) -> Pose2D:
    """Return the robot's pose in the frame odom."""
    yaw, radius = TURN * at_s, SPEED / TURN
    return Pose2D(radius * math.sin(yaw), radius * (1.0 - math.cos(yaw)), yaw)


def laser(at_s: float) -> Pose2D:
    """Return the laser's pose in the map."""
    at = pose(at_s)
    x, y = LASER_M * math.cos(at.yaw), LASER_M * math.sin(at.yaw)
    return Pose2D(START.x + at.x + x, START.y + at.y + y, at.yaw)


def _link(parent: str, child: str, place: Callable[[float], tuple[float, float, float]]) -> Make:
    """Return what makes a TFMessage of one link, from its x, y and yaw."""

    def make(at_s: float, stamp_ns: int) -> Values:
        x, y, yaw = place(at_s)
        w, qx, qy, qz = from_rpy(0.0, 0.0, yaw)
        link = stamped_transform(parent, child, stamp_ns, (x, y, 0.0), (qx, qy, qz, w))
        return {"transforms": [link]}

    return make


def _streams() -> Mapping[str, Stream]:
    def place(at_s: float) -> tuple[float, float, float]:
        at = pose(at_s)
        return at.x, at.y, at.yaw

    def odometry(at_s: float, stamp_ns: int) -> Values:
        at = pose(at_s)
        w, _, _, z = from_rpy(0.0, 0.0, at.yaw)
        there = {"position": {"x": at.x, "y": at.y}, "orientation": {"w": w, "z": z}}
        speeds = {"linear": {"x": SPEED}, "angular": {"z": TURN}}
        return {
            "header": header("odom", stamp_ns),
            "child_frame_id": "base_link",
            "pose": {"pose": there, "covariance": [0.01] * 36},
            "twist": {"twist": speeds, "covariance": [0.01] * 36},
        }

    def scan(at_s: float, stamp_ns: int) -> Values:
        return {"header": header("laser", stamp_ns)} | building.scan(laser(at_s))

    def grid(_: float, stamp_ns: int) -> Values:
        return {"header": header("map", stamp_ns)} | building.grid()

    def joints(at_s: float, stamp_ns: int) -> Values:
        return {"header": header("", stamp_ns), "name": ["axle"], "position": [at_s]}

    def mount(_: float) -> tuple[float, float, float]:
        return LASER_M, 0.0, 0.0

    def localised(_: float) -> tuple[float, float, float]:
        return START.x, START.y, 0.0

    def wheel(_: float) -> tuple[float, float, float]:
        return 0.0, 0.1, 0.0

    publisher = "robot_state_publisher"
    return {
        "scan": Stream("lidar", "/scan", SCAN, scan, is_reliable=False),
        "odometry": Stream("wheels", "/odom", ODOMETRY, odometry, 20.0),
        "odom": Stream("wheels", "/tf", TF, _link("odom", "base_link", place), 20.0),
        "localisation": Stream("amcl", "/tf", TF, _link("map", "odom", localised), ahead_s=0.5),
        "map": Stream("map_server", "/map", MAP, grid, 0.0, is_latched=True),
        "joints": Stream("joints", "/joint_states", JOINTS, joints),
        "wheel": Stream(publisher, "/tf", TF, _link("base_link", "wheel", wheel)),
        "mount": Stream(
            publisher, "/tf_static", TF, _link("base_link", "laser", mount), 0.0, is_latched=True
        ),
        "description": Stream(
            publisher,
            "/robot_description",
            STRING,
            lambda _, __: {"data": URDF},
            0.0,
            is_latched=True,
        ),
    }
