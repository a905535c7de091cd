"""The ROS node against real publishers over DDS."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import Annotated, Any

import pytest
from waiting import until

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from nodes import node_of
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosbags.typesys import Stores, get_typestore
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Range
from several import several
from std_msgs.msg import Int32, String

from webviz import Display, Input, Topic
from webviz.api.frames import Frames
from webviz.api.status import Level
from webviz.data.messages import decode
from webviz.data.transforms import TransformBuffer
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.pipeline.inputs import Inputs
from webviz.ros import node
from webviz.ros.node import RosSource
from webviz.sources import Advertisement, RestrictedGraph, Rights, Subscription, merged

RANGE = "sensor_msgs/msg/Range"
STRING = "std_msgs/msg/String"
Listen = Callable[..., RosSource]


@pytest.fixture
def talker(webviz_domain: int) -> Iterator[Node]:
    with node_of(webviz_domain, "talker") as node:
        yield node


@pytest.fixture
def listen(webviz_domain: int) -> Iterator[Listen]:
    with several(lambda *args: RosSource(args, domain_id=webviz_domain)) as listen:
        yield listen


def qos(reliability: str, durability: str) -> QoSProfile:
    return QoSProfile(
        depth=5,
        reliability=ReliabilityPolicy[reliability.upper()],
        durability=DurabilityPolicy[durability.upper()],
    )


def want(source: RosSource, name: str = "/words", **choices: Any) -> None:
    source.want({name: Subscription(STRING, Topic(name, **choices))})


def texts(source: RosSource, topic: str = "/words") -> list[str]:
    return [decode(STRING, raw.cdr).data for raw in source.inbox.drain().get(topic, ())]


def requested(source: RosSource) -> tuple[str, str] | None:
    offer = source.offers().get("/words")
    return offer.requested if offer and offer.publishers else None


@pytest.mark.parametrize("reliability", ["reliable", "best_effort"])
@pytest.mark.parametrize("durability", ["volatile", "transient_local"])
def test_auto_requests_the_qos_of_the_publisher(
    talker: Node, listen: Listen, reliability: str, durability: str
) -> None:
    publisher = talker.create_publisher(String, "/words", qos(reliability, durability))
    source = listen()
    want(source)
    until(lambda: requested(source) == (reliability, durability))
    until(lambda: publisher.get_subscription_count())

    def heard_it() -> bool:
        publisher.publish(String(data="hello"))
        return "hello" in texts(source)

    until(heard_it)
    until(lambda: source.offers()["/words"].subscribers == 1)
    ours = ("/webviz", "std_msgs/msg/String", reliability, durability)

    def readers() -> list[tuple[str, ...]]:
        result = source.offers()["/words"].readers
        return [(each.node, each.type, each.reliability, each.durability) for each in result]

    until(lambda: readers() == [ours])
    assert source.clock_messages() is None


def test_a_publisher_that_takes_the_place_of_another_is_known_by_its_qos(
    talker: Node, listen: Listen, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(node, "THOROUGH_EVERY", 2)
    first = talker.create_publisher(String, "/words", qos("reliable", "volatile"))
    source = listen()
    want(source)
    until(lambda: requested(source) == ("reliable", "volatile"))
    talker.destroy_publisher(first)
    talker.create_publisher(String, "/words", qos("best_effort", "volatile"))
    until(lambda: requested(source) == ("best_effort", "volatile"))


def test_a_latched_message_from_before_arrives(talker: Node, listen: Listen) -> None:
    publisher = talker.create_publisher(String, "/words", qos("reliable", "transient_local"))
    publisher.publish(String(data="long ago"))
    source = listen()
    want(source)
    until(lambda: "long ago" in texts(source))


def test_publishers_of_both_durabilities_are_all_heard(talker: Node, listen: Listen) -> None:
    latched = talker.create_publisher(String, "/words", qos("reliable", "transient_local"))
    volatile = talker.create_publisher(String, "/words", qos("reliable", "volatile"))
    latched.publish(String(data="latched"))
    source = listen()
    want(source)
    words: set[str] = set()

    def both() -> bool:
        volatile.publish(String(data="volatile"))
        words.update(texts(source))
        return words == {"latched", "volatile"}

    until(both)


def test_an_explicit_qos_is_used_even_if_it_matches_no_publisher(
    talker: Node, listen: Listen
) -> None:
    publisher = talker.create_publisher(String, "/words", qos("best_effort", "volatile"))
    source = listen()
    want(source, reliability="reliable")
    until(lambda: requested(source) == ("reliable", "volatile"))
    publisher.publish(String(data="lost"))
    time.sleep(0.3)
    assert texts(source) == []


class Words(Display):
    """Any strings."""

    topic: Annotated[Topic, Input(STRING)] = Topic("/words")


@pytest.mark.parametrize("first", [0, 1], ids=["the strict one first", "the strict one last"])
def test_the_qos_of_each_display_is_judged_by_itself(
    talker: Node, listen: Listen, first: int
) -> None:
    """A display that requests what no publisher offers says so, and costs others no message."""
    publisher = talker.create_publisher(String, "/words", qos("best_effort", "volatile"))
    source = listen()
    displays = Words(topic=Topic("/words", reliability="reliable")), Words()
    strict, easy = (
        Inputs(each, ErrorBoundary("", strict=True), source.resolve) for each in displays
    )
    both = (strict, easy)[:: 1 - 2 * first]

    def status_of(inputs: Inputs) -> tuple[Level, str]:
        frames, offers = Frames(TransformBuffer(), "map", 0), source.offers()
        inputs.take(source.inbox.drain() if inputs is easy else {}, frames, offers, 1.0)
        status = inputs.statuses(offers, frames, lambda _: 0, 1.0)["Topic"]
        return status.level, status.text

    source.want(merged([strict.subscriptions()]))
    until(lambda: requested(source) == ("reliable", "volatile"))
    alone = status_of(strict)
    assert alone[0] is Level.ERROR
    source.want(merged(each.subscriptions() for each in both))
    until(lambda: requested(source) == ("best_effort", "volatile"))

    def is_heard() -> bool:
        publisher.publish(String(data="again"))
        return status_of(easy)[0] is Level.OK

    until(is_heard)
    remark = " Messages arrive only because another display reads the topic."
    assert status_of(strict) == (Level.ERROR, alone[1] + remark)


def test_a_topic_of_another_type_is_reported_and_not_subscribed(
    talker: Node, listen: Listen
) -> None:
    talker.create_publisher(Int32, "/words", 5)
    source = listen()
    want(source)
    expected = ("/talker", "std_msgs/msg/Int32")

    def publishers() -> list[tuple[str, str]]:
        offer = source.offers().get("/words")
        return [(p.node, p.type) for p in offer.publishers] if offer else []

    # DDS may announce a publisher before its node.
    until(lambda: publishers() == [expected])
    until(lambda: talker.count_subscribers("/words") == 0)


def test_a_released_topic_is_unsubscribed(talker: Node, listen: Listen) -> None:
    publisher = talker.create_publisher(String, "/words", 5)
    source = listen()
    want(source)
    until(lambda: publisher.get_subscription_count() == 1)
    source.want({})
    until(lambda: publisher.get_subscription_count() == 0)


def test_an_unknown_type_is_reported(listen: Listen) -> None:
    source = listen()
    source.want({"/x": Subscription("no_such_msgs/msg/Thing", Topic("/x"))})
    offer = until(lambda: o if (o := source.offers().get("/x")) and o.problem else None)
    assert "no_such_msgs/msg/Thing" in offer.problem


def test_a_message_that_is_too_large_is_a_problem_until_a_smaller_one_comes(
    talker: Node, listen: Listen, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(node, "MAX_MESSAGE", 1 << 20)
    publisher = talker.create_publisher(String, "/words", 5)
    source = listen()
    want(source)
    until(lambda: requested(source) == ("reliable", "volatile"))
    until(lambda: publisher.get_subscription_count() == 1)

    def problem_after(text: str) -> str:
        publisher.publish(String(data=text))
        return source.offers()["/words"].problem

    problem = "a message of 3 MB is above the limit of 1 MB; publish smaller ones"
    until(lambda: problem_after("x" * (3 << 20)) == problem)
    assert texts(source) == []
    until(lambda: not problem_after("short"))
    assert "short" in texts(source)


def test_names_are_resolved_and_remapped_those_that_may_be_published_too(listen: Listen) -> None:
    source = listen("--ros-args", "-r", "/scan:=/front/scan", "-r", "__ns:=/robot")
    assert source.resolve("/scan") == "/front/scan"
    assert source.resolve("odom") == "/robot/odom"
    for wrong in ("", "/a b", "9lives", "/a//b"):
        with pytest.raises(ValueError, match="is not a valid topic name: "):
            source.resolve(wrong)
    restricted_graph = RestrictedGraph(
        source, Rights(publish=("/scan", "odom", "arm/*", "~/*")), lambda: ("/*",)
    )
    names = ("/front/scan", "/robot/odom", "/robot/arm/goal", "/robot/webviz/x")
    assert [restricted_graph.refusal(name) for name in names] == [""] * 4
    assert all(map(restricted_graph.refusal, ("/scan", "/odom", "/arm/goal", "/webviz/x")))


def test_simulated_time_is_the_clock_topic(talker: Node, listen: Listen) -> None:
    source = listen("--ros-args", "-p", "use_sim_time:=true")
    assert source.now_ns() == 0
    publisher = talker.create_publisher(Clock, "/clock", 1)
    clock = Clock()
    clock.clock.sec = 42

    def ticked() -> bool:
        publisher.publish(clock)
        return source.now_ns() == 42_000_000_000

    assert source.clock_messages() == 0
    until(ticked)
    assert source.clock_messages() == 1, "a message that changes nothing is none"
    clock.clock.sec = 43
    until(lambda: publisher.publish(clock) or source.clock_messages() == 2)


def test_subscriptions_end_while_events_of_incompatible_publishers_wait(
    talker: Node, listen: Listen, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = [f"/words{number}" for number in range(20)]
    for name in names:
        talker.create_publisher(String, name, qos("best_effort", "volatile"))
    nodes: list[Node] = []

    def make(*args: Any, **options: Any) -> Node:
        nodes.append(Node(*args, **options))
        return nodes[-1]

    monkeypatch.setattr(node, "Node", make)
    source = listen()
    (own_node,) = nodes
    own = set(own_node.waitables)
    all_names = {name: Subscription(STRING, Topic(name, reliability="reliable")) for name in names}
    for _ in range(8):
        for subscriptions in (all_names, {}):
            source.want(subscriptions)
            # Its thread would have ended, which fails the test.
            until(
                lambda subscriptions=subscriptions: (
                    subscriptions.keys() == {*filter(talker.count_subscribers, names)}
                ),
                seconds=20,
            )
    # Publishers, too, are destroyed while the node spins.
    advertised = source.graph.advertise({Advertisement("/out", STRING, "reliable", "volatile", 1)})
    advertised.result(20)
    assert set(own_node.waitables) == own, "events would wait in the executor"


def test_close_leaves_no_thread_and_no_node(talker: Node, webviz_domain: int) -> None:
    source = RosSource(domain_id=webviz_domain)
    until(lambda: "webviz" in talker.get_node_names())
    source.close()
    assert not [t for t in threading.enumerate() if t.name == "webviz-ros"]
    until(lambda: "webviz" not in talker.get_node_names())


def test_messages_of_an_older_distribution_have_defaults_for_missing_fields(
    talker: Node, listen: Listen
) -> None:
    """Its Range has no variance; DDS compares the names of types alone."""
    older = get_typestore(Stores.ROS2_HUMBLE)
    header = older.types["std_msgs/msg/Header"](
        stamp=older.types["builtin_interfaces/msg/Time"](sec=1, nanosec=0), frame_id="sonar"
    )
    message = older.types[RANGE](header, 1, 0.5, 0.1, 4.0, 2.5)
    publisher = talker.create_publisher(Range, "/sonar", 1)
    source = listen()
    source.want({"/sonar": Subscription(RANGE, Topic("/sonar"))})
    cdr = bytes(older.serialize_cdr(message, RANGE))
    arrived: list[Any] = []

    def is_received() -> bool:
        """Return whether one has come; the first may be sent before its match."""
        publisher.publish(cdr)
        arrived.extend(source.inbox.drain().get("/sonar", ()))
        return bool(arrived)

    until(is_received)
    decoded = decode(RANGE, arrived[0].cdr)
    assert (decoded.header.frame_id, decoded.range, decoded.variance) == ("sonar", 2.5, 0.0)
