"""Differences between distributions of ROS: in one place, and with what each of them has."""

from __future__ import annotations

import ast
import importlib.util
import re
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

import rclpy_names
from nodes import SpunNode
from rclpy.client import Client
from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.service import Service
from rclpy.subscription import Subscription as RclpySubscription
from rclpy.task import Future
from rclpy.topic_endpoint_info import TopicEndpointInfo
from std_msgs.msg import String
from std_srvs.srv import Empty
from waiting import until

from webviz import Topic
from webviz.data.messages import encode
from webviz.ros import distribution
from webviz.ros.node import RosSource
from webviz.ros.types import MessageTypeError, classes, message_class
from webviz.sources import Subscription

EMPTY = "std_srvs/srv/Empty_Request"
ROOT = Path(__file__).parents[2]
PLACE = "webviz/ros/distribution.py"
NAMES = re.compile(
    r"\b(foxy|galactic|humble|iron|jazzy|kilted|lyrical|rolling)\b|(?-i:ROS2_[A-Z])", re.I
)
NAMED = {
    PLACE,
    "webviz/checks/peer/distributions.py",  # of whose nodes others know nothing
    "webviz/data/messages/distributions.py",  # fields of messages
    "webviz/data/messages/typestore.py",  # the fields that are known here
    "webviz/data/recordings/folder_writing.py",  # of whose types bags are written
    "webviz/shell/live_source.py",  # what to source
    "sim/webviz_sim/node.py",
}
"""Modules whose code names a distribution."""
CLASSES = (
    Client,
    Context,
    Executor,
    Future,
    Node,
    Publisher,
    Service,
    RclpySubscription,
    TopicEndpointInfo,
)


def modules() -> Iterator[tuple[str, ast.Module]]:
    for folder in ("webviz", "displays/webviz_displays", "urdf", "sim"):
        for path in (ROOT / folder).rglob("*.py"):
            yield path.relative_to(ROOT).as_posix(), ast.parse(path.read_text(encoding="utf-8"))


def nodes_that_run(tree: ast.Module) -> Iterator[ast.AST]:
    """Walk a module without what only type checkers read."""
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            waiting += node.orelse
        else:
            waiting += ast.iter_child_nodes(node)


def docstrings(tree: ast.Module) -> set[ast.AST]:
    return {node.value for node in ast.walk(tree) if isinstance(node, ast.Expr)}


def names_that_some_lack() -> tuple[set[str], set[str], set[str]]:
    lack = rclpy_names.newer_than
    attributes = lack("humble", rclpy_names.ATTRIBUTES)
    return (
        lack("humble", rclpy_names.MODULES) | rclpy_names.ELSEWHERE,
        {each.partition(".")[2] for each in attributes},
        lack("humble", rclpy_names.KEYWORDS),
    )


def test_other_modules_use_only_names_of_every_rclpy() -> None:
    lacked, attributes, keywords = names_that_some_lack()
    results = set()
    for path, tree in modules():
        knows_rclpy = path.startswith(("webviz/ros/", "sim/"))
        for node in nodes_that_run(tree):
            match node:
                case ast.ImportFrom(module=module) if module in lacked:
                    results.add((path, module))
                case ast.Import(names=names):
                    results |= {(path, each.name) for each in names if each.name in lacked}
                case ast.Attribute(attr=name) if knows_rclpy and name in attributes:
                    results.add((path, name))
                case ast.Call() if knows_rclpy:
                    used = {each.arg for each in node.keywords} & keywords
                    results |= {(path, each) for each in used}
    assert {path for path, _ in results} == {PLACE}, results
    assert {name for _, name in results} == {
        "rclpy.event_handler",
        "rclpy.experimental.events_executor",
        "rclpy.qos_event",
        "get_publisher_count",
        "service_name",
    }


def test_no_other_module_asks_for_the_distribution() -> None:
    named, asking = set(), set()
    for path, tree in modules():
        texts = docstrings(tree)
        for node in ast.walk(tree):
            match node:
                case ast.Constant(value=str(text)) if node not in texts and NAMES.search(text):
                    named.add(path)
                case ast.Attribute(attr=name) if NAMES.match(name):
                    named.add(path)
                case ast.Attribute(value=ast.Name("distribution"), attr="name"):
                    asking.add(path)
                case ast.ImportFrom(module="webviz.ros.distribution", names=names):
                    asking |= {path for each in names if each.name == "name"}
    assert named == NAMED
    assert not asking


def test_rclpy_has_the_names_that_are_listed_for_its_distribution() -> None:
    here = distribution.name()
    assert here in rclpy_names.DISTRIBUTIONS
    classes_by_name = {each.__name__: each for each in CLASSES}

    def listed(names: dict[str, set[str]]) -> set[str]:
        return set().union(*names.values()) - rclpy_names.newer_than(here, names)

    assert [each for each in listed(rclpy_names.MODULES) if not find_spec(each)] == []
    for each in listed(rclpy_names.ATTRIBUTES):
        owner, _, name = each.partition(".")
        assert hasattr(classes_by_name[owner], name), each


@pytest.mark.parametrize(
    ("version", "sourced", "name"),
    [
        ("3.3.15", "", "humble"),
        ("4.1.7", "humble", "iron"),
        ("7.1.9", "humble", "jazzy"),
        ("9.1.2", "", "kilted"),
        ("99.0.0", "lyrical", "lyrical"),
        ("99.0.0", "", ""),
    ],
)
def test_the_distribution_is_that_of_rclpy(
    monkeypatch: pytest.MonkeyPatch, version: str, sourced: str, name: str
) -> None:
    monkeypatch.setattr(distribution.metadata, "version", lambda _: version)
    monkeypatch.setenv("ROS_DISTRO", sourced)
    assert distribution.name() == name
    assert distribution.apt_name("std_srvs") == f"ros-{name or '<distribution>'}-std-srvs"
    assert distribution.has_known_type_supports() == (name in ("jazzy", "kilted"))


def test_types_need_their_package_where_structs_are_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(distribution.metadata, "version", lambda _: "3.3.15")
    classes.composed.cache_clear()
    expected = (
        "map_msgs/msg/OccupancyGridUpdate needs its package with this ROS 2: "
        "install ros-humble-map-msgs with apt."
    )
    with pytest.raises(MessageTypeError, match=re.escape(expected)):
        message_class("map_msgs/msg/OccupancyGridUpdate")
    assert message_class("std_msgs/msg/String") is String


@pytest.fixture
def spun(webviz_domain: int) -> Iterator[SpunNode]:
    spun = SpunNode(webviz_domain, "distribution_test")
    yield spun
    spun.close()


def test_names_and_counts_without_the_attributes_that_humble_lacks(
    spun: SpunNode, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = spun.node
    client = node.create_client(Empty, "/nothing")
    subscription = node.create_subscription(String, "/text", lambda _: None, 1)
    node.create_publisher(String, "/text", 1)

    def reads() -> tuple[str, int]:
        count = distribution.publisher_count(node, subscription)
        return distribution.service_name(client), count

    until(lambda: reads() == ("/nothing", 1))
    monkeypatch.delattr(Client, "service_name")
    monkeypatch.delattr(RclpySubscription, "get_publisher_count")
    until(lambda: reads() == ("/nothing", 1))


@pytest.mark.filterwarnings("ignore:importing 'qos_event' is deprecated")
def test_events_come_from_the_module_that_humble_has(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "webviz.ros.distribution", distribution)
    callbacks = importlib.import_module("rclpy.qos_event").SubscriptionEventCallbacks
    monkeypatch.setitem(sys.modules, "rclpy.event_handler", None)
    spec = find_spec("webviz.ros.distribution")
    assert spec is not None
    assert spec.loader is not None
    older = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(older)
    assert type(older.NO_EVENTS_OF_SUBSCRIPTIONS) is callbacks


def test_the_default_executor_serves_a_viewer_too(
    spun: SpunNode, webviz_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Humble, Iron and the first releases of Jazzy have no other."""
    monkeypatch.setitem(sys.modules, "rclpy.experimental.events_executor", None)
    spun.node.create_service(Empty, "/reset", lambda _, response: response)
    publisher = spun.node.create_publisher(String, "/text", 1)
    executors: list[object] = []
    choose = distribution.executor
    monkeypatch.setattr(
        distribution, "executor", lambda context: executors.append(choose(context)) or executors[-1]
    )
    source = RosSource(domain_id=webviz_domain)
    try:
        assert [type(each) for each in executors] == [SingleThreadedExecutor]
        source.want({"/text": Subscription("std_msgs/msg/String", Topic("/text"))})

        def is_received() -> bool:
            """Return whether one has come; the first may be sent before its match."""
            publisher.publish(String(data="hello"))
            return bool(source.inbox.drain().get("/text"))

        spun.until(is_received)
        answer = source.graph.call("/reset", "std_srvs/srv/Empty", encode(EMPTY), 10.0)
        spun.until(answer.done)
        assert answer.result()
    finally:
        source.close()
