"""Commands of a ROS 2 course against the graph of `webviz demo`, as against a TurtleBot's.

`ros2` itself is not on PyPI. Each test makes the requests of one command, with rclpy or, for bags,
with rosbags; displays/docs/ros/course.md has the commands.
"""

from __future__ import annotations

import functools
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from program import Program
from ruamel.yaml import YAML
from waiting import until

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from nav_msgs.msg import OccupancyGrid, Odometry
from nodes import response_of
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    ListParameters,
    SetParameters,
)
from rclpy.action.graph import (
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from std_srvs.srv import Empty

from webviz.data.messages import decode
from webviz.data.transforms import TransformBuffer
from webviz.ros.types import message_class
from webviz.shell.testing.domain import isolated_domain

pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

STORE = get_typestore(Stores.ROS2_JAZZY)
TOPICS = {
    "/cmd_vel": "geometry_msgs/msg/Twist",
    "/goal_pose": "geometry_msgs/msg/PoseStamped",
    "/initialpose": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/map": "nav_msgs/msg/OccupancyGrid",
    "/odom": "nav_msgs/msg/Odometry",
    "/robot_description": "std_msgs/msg/String",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
}
RECORDED = ["/odom", "/scan", "/tf", "/tf_static", "/map"]


class Terminal(Node):
    """The node that each command of `ros2` starts, here one for all."""

    def __init__(self, context: Context) -> None:
        super().__init__("terminal", context=context)
        self.loop = SingleThreadedExecutor(context=context)
        self.loop.add_node(self)

    def wait_for(self, condition: Callable[[], Any], seconds: float = 60.0) -> Any:
        turn = functools.partial(self.loop.spin_once, timeout_sec=0.05)
        return until(condition, turn=turn, seconds=seconds)

    def call(self, type: Any, name: str, **fields: Any) -> Any:
        client = self.create_client(type, name)
        response = response_of(client, type.Request(**fields), self.loop)
        self.destroy_client(client)
        return response

    def echo(self, topics: dict[str, str], counts: dict[str, int]) -> dict[str, list[bytes]]:
        """The first messages of topics as bytes, with the QoS that `ros2 topic echo` chooses."""
        received: dict[str, list[bytes]] = {topic: [] for topic in topics}
        subscriptions = []
        for topic, type in topics.items():
            [publisher] = self.get_publishers_info_by_topic(topic)
            offered = publisher.qos_profile
            qos = QoSProfile(
                depth=100, reliability=offered.reliability, durability=offered.durability
            )
            take = received[topic].append
            subscriptions.append(
                self.create_subscription(message_class(type), topic, take, qos, raw=True)
            )
        self.wait_for(lambda: all(len(received[t]) >= counts.get(t, 1) for t in topics))
        for subscription in subscriptions:
            self.destroy_subscription(subscription)
        return received


@pytest.fixture(scope="module")
def terminal(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Terminal]:
    """A node beside a running `webviz demo`."""
    log = tmp_path_factory.mktemp("log") / "output.txt"
    with isolated_domain() as domain:
        demo = [sys.executable, "-m", "webviz", "demo", "--port", "0"]
        program = Program(demo, {**os.environ, "PYTHONUNBUFFERED": "1"}, log)
        context = Context()
        context.init(domain_id=domain)
        node = Terminal(context)
        try:
            program.url()
            services = ("/reset_odom", "/webviz/reset")
            node.wait_for(
                lambda: {name for name, _ in node.get_service_names_and_types()} >= {*services}
            )
            node.wait_for(lambda: {"sim", "webviz"} <= set(node.get_node_names()))
            yield node
        finally:
            node.loop.shutdown()
            node.destroy_node()
            context.try_shutdown()
            program.end()


def test_topic_list_has_the_topics_of_a_turtlebot(terminal: Terminal) -> None:
    types = dict(terminal.get_topic_names_and_types())
    assert {topic: types.get(topic) for topic in TOPICS} == {t: [k] for t, k in TOPICS.items()}


def test_topic_info_names_the_nodes_and_their_qos(terminal: Terminal) -> None:
    [scan] = terminal.get_publishers_info_by_topic("/scan")
    assert (scan.node_name, scan.node_namespace) == ("sim", "/")
    assert scan.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
    assert str(scan.topic_type_hash).startswith("RIHS01_")
    [grid] = terminal.get_publishers_info_by_topic("/map")
    assert grid.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
    [driver] = terminal.get_subscriptions_info_by_topic("/cmd_vel")
    assert driver.node_name == "sim"


def test_topic_echo_hz_and_bw_receive_the_odometry(terminal: Terminal) -> None:
    messages = terminal.echo({"/odom": TOPICS["/odom"]}, {"/odom": 26})["/odom"]
    odometry = [decode(TOPICS["/odom"], cdr) for cdr in messages]
    stamps = [o.header.stamp.sec + o.header.stamp.nanosec * 1e-9 for o in odometry]
    assert (stamps[25] - stamps[0]) / 25 == pytest.approx(0.02, abs=0.002)
    assert 700 < len(messages[0]) < 800


def test_topic_echo_once_receives_the_latched_map(terminal: Terminal) -> None:
    [cdr, *_] = terminal.echo({"/map": TOPICS["/map"]}, {})["/map"]
    assert decode(TOPICS["/map"], cdr).info.resolution == pytest.approx(0.05)


def test_node_list_and_info(terminal: Terminal) -> None:
    assert {"sim", "webviz"} <= set(terminal.get_node_names())
    publishers = dict(terminal.get_publisher_names_and_types_by_node("sim", "/"))
    assert {"/odom", "/scan", "/tf"} <= publishers.keys()
    subscribers = dict(terminal.get_subscriber_names_and_types_by_node("sim", "/"))
    assert {"/cmd_vel", "/goal_pose", "/initialpose"} <= subscribers.keys()
    services = dict(terminal.get_service_names_and_types_by_node("sim", "/"))
    assert {"/reset_odom", "/sim/set_parameters", "/sim/describe_parameters"} <= services.keys()
    services = dict(terminal.get_service_names_and_types_by_node("webviz", "/"))
    assert {"/webviz/load_config", "/webviz/screenshot", "/webviz/reset_time"} <= services.keys()


@pytest.mark.parametrize("node", ["sim", "webviz"])
def test_param_list_and_describe_explain_every_parameter(terminal: Terminal, node: str) -> None:
    names = terminal.call(ListParameters, f"/{node}/list_parameters").result.names
    ours = [
        name for name in names if name not in ("use_sim_time", "start_type_description_service")
    ]
    assert len(ours) >= 3
    described = terminal.call(DescribeParameters, f"/{node}/describe_parameters", names=ours)
    assert all(descriptor.description for descriptor in described.descriptors)
    by_name = {descriptor.name: descriptor for descriptor in described.descriptors}
    if node == "sim":
        [limits] = by_name["scan_noise"].floating_point_range
        assert (limits.from_value, limits.to_value) == (0.0, 10.0)
        [limits] = by_name["scan_beams"].integer_range
        assert (limits.from_value, limits.to_value) == (1, 20_000)


def test_param_set_and_get(terminal: Terminal) -> None:
    for node, name, value in (("sim", "tour_speed", 0.2), ("webviz", "fixed_frame", "odom")):
        expected = [Parameter(name, value=value).to_parameter_msg()]
        answer = terminal.call(SetParameters, f"/{node}/set_parameters", parameters=expected)
        assert answer.results[0].successful, answer.results[0].reason
        [read] = terminal.call(GetParameters, f"/{node}/get_parameters", names=[name]).values
        assert parameter_value_to_python(read) == value


def test_a_dump_of_all_parameters_starts_another_simulator(
    terminal: Terminal, tmp_path: Path
) -> None:
    names = terminal.call(ListParameters, "/sim/list_parameters").result.names
    values = terminal.call(GetParameters, "/sim/get_parameters", names=names).values
    dump: dict[str, Any] = dict(zip(names, map(parameter_value_to_python, values), strict=True))
    dump |= {"start_pose": list(dump["start_pose"]), "scan_noise": 0.03}
    with (tmp_path / "sim.yaml").open("w") as file:
        YAML().dump({"/other": {"ros__parameters": dump}}, file)
    sim = [sys.executable, "-m", "webviz_sim", "--until-stdin-closes"]
    options = ["--ros-args", "-r", "__node:=other", "--params-file", str(tmp_path / "sim.yaml")]
    with subprocess.Popen([*sim, *options], stdin=subprocess.PIPE) as process:
        [noise] = terminal.call(GetParameters, "/other/get_parameters", names=["scan_noise"]).values
        assert noise.double_value == 0.03
        assert process.stdin is not None
        process.stdin.close()
    terminal.wait_for(lambda: "other" not in terminal.get_node_names())
    terminal.wait_for(lambda: len(terminal.get_publishers_info_by_topic("/odom")) == 1)


def test_service_list_type_and_call(terminal: Terminal) -> None:
    assert ("/reset_odom", ["std_srvs/srv/Empty"]) in terminal.get_service_names_and_types()
    terminal.call(Empty, "/reset_odom")
    received: list[Odometry] = []
    terminal.create_subscription(Odometry, "/odom", received.append, 10)
    terminal.wait_for(lambda: received)
    place = received[0].pose.pose.position
    assert abs(place.x) + abs(place.y) < 0.5


def test_action_list_has_nav2s(terminal: Terminal) -> None:
    actions = dict(get_action_names_and_types(terminal))
    assert actions["/navigate_to_pose"] == ["nav2_msgs/action/NavigateToPose"]
    servers = get_action_server_names_and_types_by_node(terminal, "sim", "/")
    assert {"/navigate_to_pose", "/follow_waypoints"} <= dict(servers).keys()


def test_tf2_echo_and_view_frames_find_one_tree(terminal: Terminal) -> None:
    topics = {topic: TOPICS[topic] for topic in ("/tf", "/tf_static")}
    buffer = TransformBuffer()
    for topic, messages in terminal.echo(topics, {"/tf": 50}).items():
        for cdr in messages:
            for t in decode(topics[topic], cdr).transforms:
                static = topic == "/tf_static"
                buffer.set_transform(
                    t.parent, t.child, t.stamp_ns, t.translation, t.rotation, static
                )
    assert buffer.lookup("base_link", "base_scan", 0).translation[2] > 0.1
    assert buffer.lookup("map", "wheel_left_link", 0).stamp_ns > 0
    parents = {frame: link.transform for frame in buffer.frames() if (link := buffer.link(frame))}
    assert set(buffer.frames()) - parents.keys() == {"map"}


def test_bag_record_and_play(terminal: Terminal, tmp_path: Path) -> None:
    topics = {topic: TOPICS[topic] for topic in RECORDED}
    received = terminal.echo(topics, {"/odom": 20, "/scan": 3, "/tf": 20})
    with Writer(tmp_path / "run", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for topic, messages in received.items():
            connection = writer.add_connection(topic, topics[topic], typestore=STORE)
            for number, cdr in enumerate(messages):
                writer.write(connection, 1_000_000_000 + number * 20_000_000, cdr)
    with AnyReader([tmp_path / "run"]) as reader:
        grids: list[OccupancyGrid] = []
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        player = terminal.create_publisher(OccupancyGrid, "/played/map", latched)
        terminal.create_subscription(OccupancyGrid, "/played/map", grids.append, latched)
        counts = dict.fromkeys(RECORDED, 0)
        for connection, _, cdr in reader.messages():
            reader.deserialize(cdr, connection.msgtype)  # as others read it
            counts[connection.topic] += 1
            if connection.topic == "/map":
                player.publish(bytes(cdr))
        assert counts == {topic: len(messages) for topic, messages in received.items()}
        terminal.wait_for(lambda: grids)
        assert grids[0].info.width > 0
