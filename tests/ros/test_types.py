import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from waiting import until

pytest.importorskip("rclpy", reason="rclpy is not installed", exc_type=ImportError)

from nodes import SpunNode, response_of
from rclpy.executors import Executor
from rclpy.node import Node

from webviz.data.messages import (
    UnknownTypeError,
    encode,
    interfaces,
    register,
    type_exists,
    typestore,
)
from webviz.ros.types import MessageTypeError, learn, message_class, service_class, type_hash
from webviz.ros.types.classes import composed_message, composed_service
from webviz.ros.types.wire import RawPayload

# rclpy's own imports: the parser of an old lark uses a module that Python 3.11 deprecates.
pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

TF_HASH = "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"
NESTED_TF = ["builtin_interfaces/msg/Time", "geometry_msgs/msg/Quaternion"]
ROOT = Path(__file__).parents[2]
Peers = Callable[..., subprocess.Popen[bytes]]

# A bag's schema: the main type, then what it contains.
CUSTOM = f"""Part[2] parts
string<=7 label
float32[<=3] few
uint8[] many
{"=" * 80}
MSG: webviz_test_msgs/Part
bool on
geometry_msgs/Point at
"""

PEER = """
import sys, time
import rclpy
from rclpy.signals import SignalHandlerOptions
from webviz.data.messages import register
from webviz.ros.types import message_class
role, type_name, topic = sys.argv[1:4]
definition = sys.argv[4] if len(sys.argv) > 4 else ""
rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
node = rclpy.create_node("peer_" + role)
if definition:
    register(type_name, definition)
cls = message_class(type_name)
if role == "talker":
    publisher = node.create_publisher(cls, topic, 10)
    while True:
        publisher.publish(sys.stdin.buffer.peek()[:8])
        rclpy.spin_once(node, timeout_sec=0.05)
else:
    node.create_subscription(cls, topic, lambda raw: print(raw.hex(), flush=True), 10, raw=True)
    while True:
        rclpy.spin_once(node, timeout_sec=0.05)
"""


@pytest.fixture
def ros(webviz_domain: int) -> Iterator[tuple[Node, Executor]]:
    """A context and node of this process."""
    spun = SpunNode(webviz_domain, "types_test")
    yield spun.node, spun.executor
    spun.close()


@pytest.fixture
def peer(webviz_domain: int) -> Iterator[Peers]:
    """Start the other process; it is fed one message on stdin and prints what it receives."""
    started = []

    def start(role: str, *args: str) -> subprocess.Popen[bytes]:
        env = os.environ | {
            "ROS_DOMAIN_ID": str(webviz_domain),
            "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path[1:]]),
        }
        process = subprocess.Popen(
            [sys.executable, "-c", SERVER if role == "server" else PEER, role, *args],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=env,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        process.terminate()
        process.communicate()


def spin_until(executor: Executor, condition: Callable[[], object], seconds: float = 60.0) -> None:
    until(condition, turn=lambda: executor.spin_once(timeout_sec=0.05), seconds=seconds)


def test_an_installed_type_is_the_real_class() -> None:
    from sensor_msgs.msg import LaserScan

    assert message_class("sensor_msgs/msg/LaserScan") is LaserScan


def test_the_same_call_returns_the_same_class() -> None:
    name = "map_msgs/msg/OccupancyGridUpdate"
    assert message_class(name) is message_class(name)


@pytest.mark.parametrize("name", ["", "LaserScan", "sensor_msgs/LaserScan", "a/srv/B", "a/msg/b/c"])
def test_a_malformed_name_is_refused_in_one_sentence(name: str) -> None:
    with pytest.raises(MessageTypeError, match=r"is not a message type name\. Write .*\.$"):
        message_class(name)


def test_an_unknown_type_names_the_package_to_install() -> None:
    with pytest.raises(MessageTypeError, match=r"no_msgs/msg/No is known\. Install its package"):
        message_class("no_msgs/msg/No")


def test_a_missing_package_under_another_rmw_names_the_command_to_install_it() -> None:
    script = (
        "import webviz.ros.types.classes as t\n"
        "t.get_rmw_implementation_identifier = lambda: 'rmw_cyclonedds_cpp'\n"
        "try: t.message_class('map_msgs/msg/OccupancyGridUpdate')\n"
        "except t.MessageTypeError as error: print(error)\n"
    )
    if find_spec("map_msgs"):
        pytest.skip("map_msgs is installed here")
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path[1:]])}
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, env=env)
    assert "needs its package with rmw_cyclonedds_cpp: install ros-jazzy-map-msgs" in run.stdout


def test_the_hash_of_tf_message_is_the_published_one() -> None:
    assert type_hash("tf2_msgs/msg/TFMessage") == TF_HASH


def installed_hashes(kind: str) -> dict[str, str]:
    """The hash of every type whose description is installed, by name."""
    result = {}
    for path in sorted((Path(sys.prefix) / "share").glob(f"*/{kind}/*.json")):
        described = json.loads(path.read_text())
        name = described["type_description_msg"]["type_description"]["type_name"]
        hashes = {each["type_name"]: each["hash_string"] for each in described["type_hashes"]}
        result[name] = hashes[name]
    if not result:
        pytest.skip(f"no {kind} descriptions are installed under this Python's prefix")
    return result


def test_hashes_equal_those_of_every_installed_message() -> None:
    hashes = {name: hash_ for name, hash_ in installed_hashes("msg").items() if type_exists(name)}
    assert {name: type_hash(name) for name in hashes} == hashes
    assert len(hashes) > 100


def test_a_composed_class_has_no_instances() -> None:
    if find_spec("map_msgs"):
        pytest.skip("map_msgs is installed here")
    with pytest.raises(TypeError, match="use serialised bytes"):
        message_class("map_msgs/msg/OccupancyGridUpdate")()


def known_class(name: str, definition: str) -> Any:
    if definition:
        register(name, definition)
    return message_class(name)


MESSAGES = [
    ("tf2_msgs/msg/TFMessage", "", bytes([0, 1, 0, 0, 0, 0, 0, 0])),
    ("webviz_test_msgs/msg/Custom", CUSTOM, bytes([0, 1, 0, 0, 1, 2, 3, 4])),
]


@pytest.mark.parametrize(("name", "definition", "payload"), MESSAGES)
def test_a_subscription_gets_the_bytes_that_another_process_published(
    ros: tuple[Node, Executor], peer: Peers, name: str, definition: str, payload: bytes
) -> None:
    node, executor = ros
    received = []
    cls = known_class(name, definition)
    subscription = node.create_subscription(cls, "/forged", received.append, 10, raw=True)
    talker = peer("talker", name, "/forged", *filter(None, [definition]))
    assert talker.stdin is not None
    talker.stdin.write(payload)
    talker.stdin.flush()
    spin_until(executor, lambda: len(received) >= 3)
    assert set(received) == {payload}
    info = node.get_publishers_info_by_topic("/forged")[0]
    assert info.topic_type == name
    assert str(info.topic_type_hash) == type_hash(name)
    node.destroy_subscription(subscription)


@pytest.mark.parametrize(("name", "definition", "payload"), MESSAGES)
def test_another_process_gets_the_bytes_published_here(
    ros: tuple[Node, Executor], peer: Peers, name: str, definition: str, payload: bytes
) -> None:
    node, executor = ros
    listener = peer("listener", name, "/forged", *filter(None, [definition]))
    publisher = node.create_publisher(known_class(name, definition), "/forged", 10)
    spin_until(executor, lambda: publisher.get_subscription_count() > 0)
    publisher.publish(payload)
    assert listener.stdout is not None
    assert bytes.fromhex(listener.stdout.readline().decode()) == payload
    info = node.get_subscriptions_info_by_topic("/forged")[0]
    assert (info.topic_type, str(info.topic_type_hash)) == (name, type_hash(name))


def test_a_real_package_and_a_composed_class_understand_each_other(
    ros: tuple[Node, Executor],
) -> None:
    from geometry_msgs.msg import PointStamped
    from rclpy.serialization import serialize_message

    node, executor = ros
    received = []
    point = PointStamped()
    point.header.frame_id = "map"
    point.point.y = 2.5
    composed = composed_message("geometry_msgs/msg/PointStamped")
    node.create_subscription(PointStamped, "/point", received.append, 10)
    publisher = node.create_publisher(composed, "/point", 10)
    spin_until(executor, lambda: publisher.get_subscription_count() > 0)
    publisher.publish(serialize_message(point))
    spin_until(executor, lambda: received)
    assert received == [point]


def test_the_node_describes_a_composed_type_on_request(ros: tuple[Node, Executor]) -> None:
    from type_description_interfaces.srv import GetTypeDescription

    node, executor = ros
    node.create_publisher(message_class("tf2_msgs/msg/TFMessage"), "/tf", 10)
    client = node.create_client(GetTypeDescription, "/types_test/get_type_description")
    request = GetTypeDescription.Request(type_name="tf2_msgs/msg/TFMessage", type_hash=TF_HASH)
    answer = response_of(client, request, executor)
    assert answer.successful, answer.failure_reason
    [field] = answer.type_description.type_description.fields
    assert (field.name, field.type.type_id) == ("transforms", 145)
    assert field.type.nested_type_name == "geometry_msgs/msg/TransformStamped"
    referenced = answer.type_description.referenced_type_descriptions
    assert [other.type_name for other in referenced][:2] == NESTED_TF


def test_a_subscription_without_raw_raises_instead_of_crashing(ros: tuple[Node, Executor]) -> None:
    if find_spec("map_msgs"):
        pytest.skip("map_msgs is installed here")
    node, executor = ros
    cls = message_class("map_msgs/msg/OccupancyGridUpdate")
    node.create_subscription(cls, "/cooked", print, 10)
    publisher = node.create_publisher(cls, "/cooked", 10)
    spin_until(executor, lambda: publisher.get_subscription_count() > 0)
    publisher.publish(bytes(8))
    with pytest.raises(MemoryError):
        spin_until(executor, lambda: False)


def test_hashes_equal_those_of_every_installed_service() -> None:
    for name, hash_ in installed_hashes("srv").items():
        learn(name)  # with the messages that the service holds
        assert type_hash(name) == hash_, name


SERVER = """
import sys
import rclpy
from rclpy.signals import SignalHandlerOptions
from webviz.ros.types import service_class
from webviz.ros.types.wire import RawPayload
rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
node = rclpy.create_node("server")
def answer(request, response):
    return RawPayload.__init__(response, bytes([0, 1, 0, 0, request.cdr[4]])) or response
node.create_service(service_class("nav2_msgs/srv/ManageLifecycleNodes"), "/manage", answer)
print("ready", flush=True)
rclpy.spin(node)
"""


def test_a_service_without_its_package_answers_over_the_wire(
    ros: tuple[Node, Executor], peer: Peers
) -> None:
    if find_spec("nav2_msgs"):
        pytest.skip("nav2_msgs is installed here")
    node, executor = ros
    peer("server")
    cls = service_class("nav2_msgs/srv/ManageLifecycleNodes")
    client = node.create_client(cls, "/manage")
    for command in (1, 0):
        request = cls.Request(bytes([0, 1, 0, 0, command]))
        assert response_of(client, request, executor).cdr[:5] == bytes([0, 1, 0, 0, command])


def test_a_real_service_and_a_composed_client_understand_each_other(
    ros: tuple[Node, Executor],
) -> None:
    from std_srvs.srv import SetBool

    node, executor = ros

    def switch(request: Any, response: Any) -> Any:
        response.success, response.message = not request.data, "was done"
        return response

    node.create_service(SetBool, "/switch", switch)
    composed = composed_service("std_srvs/srv/SetBool")
    client = node.create_client(composed, "/switch")
    spin_until(executor, client.service_is_ready)
    future = client.call_async(composed.Request(bytes([0, 1, 0, 0, 1])))
    spin_until(executor, future.done)
    answer = future.result()
    assert isinstance(answer, RawPayload)
    assert answer.cdr[:21] == bytes([0, 1, 0, 0, 0, 0, 0, 0, 9, 0, 0, 0]) + b"was done\0"


def test_a_form_of_an_installed_type_needs_no_text() -> None:
    typestore.find_with(learn)
    assert interfaces.action("test_msgs/action/Fibonacci").goal == "test_msgs/action/Fibonacci_Goal"
    assert encode("test_msgs/action/Fibonacci_Goal", {"order": 5})
    assert typestore.fields("test_msgs/msg/MultiNested")
    with pytest.raises(UnknownTypeError, match=r"No definition of no_msgs/srv/Such is known\."):
        interfaces.service("no_msgs/srv/Such")
