"""A source over Zenoh, with a router and robots of a second implementation."""

from __future__ import annotations

import time

import pytest
import xxhash
from waiting import until
from zenoh_robot import ZenohRobot, ZenohRouter, free_port

from webviz.api.declared import Topic
from webviz.data.messages import decode, encode
from webviz.sources import Advertisement, NotConnected, Subscription
from webviz.sources.zenoh.address import zenoh_address
from webviz.sources.zenoh.source import ZenohSource

STRING = "std_msgs/msg/String"
SET_BOOL = "std_srvs/srv/SetBool"
TWIST = "geometry_msgs/msg/Twist"


def want(source: ZenohSource, topic: str, type: str = STRING, resubscriptions: int = 0) -> None:
    source.want({topic: Subscription(type, Topic(topic), resubscriptions=resubscriptions)})


def texts(source: ZenohSource, topic: str = "/words") -> list[str]:
    arrived = source.inbox.drain().get(topic, ())
    return [decode(STRING, raw.cdr, raw.types).data for raw in arrived]


def tokens_of(robot: ZenohRobot) -> list[str]:
    """Return the tokens of the domain, as a robot finds them."""
    replies = robot.session.liveliness().get("@ros2_lv/0/**")
    return [str(sample.key_expr) for sample in (reply.ok for reply in replies) if sample]


def test_messages_arrive_and_the_robot_sees_the_subscription(
    source: ZenohSource, robot: ZenohRobot
) -> None:
    publish = robot.publisher("/words", STRING)
    until(lambda: "/words" in source.offers())
    (publisher,) = source.offers()["/words"].publishers
    assert (publisher.node, publisher.type) == ("/robot", STRING)
    assert (publisher.reliability, publisher.durability) == ("reliable", "volatile")
    assert len(publisher.endpoint) == 16
    assert "/robot" in source.graph.nodes()
    want(source, "/words")
    until(lambda: source.offers()["/words"].subscribers == 1)
    assert source.offers()["/words"].requested == ("reliable", "volatile")
    time.sleep(0.1)
    publish({"data": "over Zenoh"})
    results: list[str] = []
    until(lambda: results.extend(texts(source)) or results)
    assert results == ["over Zenoh"]
    (own,) = [token for token in tokens_of(robot) if "/MS/" in token]
    assert "/MS/%/%/webviz/%words/std_msgs::msg::dds_::String_/RIHS01_" in own


def test_a_publisher_that_ends_is_gone(source: ZenohSource, router: ZenohRouter) -> None:
    robot = ZenohRobot(router.endpoint, "/ns/talker")
    robot.publisher("/words", STRING)
    until(lambda: "/words" in source.offers())
    assert "/ns/talker" in source.graph.nodes()
    robot.close()
    until(lambda: "/words" not in source.offers())
    assert "/ns/talker" not in source.graph.nodes()


def test_latched_messages_come_from_the_cache_of_the_publisher(
    source: ZenohSource, robot: ZenohRobot
) -> None:
    publish = robot.publisher("/words", STRING, is_latched=True)
    publish({"data": "latched"})
    until(lambda: "/words" in source.offers())
    assert source.offers()["/words"].is_latched
    want(source, "/words")
    results: list[str] = []
    until(lambda: results.extend(texts(source)) or results)
    assert results == ["latched"]
    want(source, "/words", resubscriptions=1)
    again: list[str] = []
    until(lambda: again.extend(texts(source)) or again)
    assert again == ["latched"], "asked again, the cache answers again"


def test_only_messages_of_the_subscribed_type_arrive(
    source: ZenohSource, robot: ZenohRobot
) -> None:
    publish = robot.publisher("/words", STRING)
    other = robot.publisher("/words", TWIST)
    until(lambda: len(source.snapshot.publishers.get("/words", ())) == 2)
    want(source, "/words")
    until(lambda: source.offers()["/words"].subscribers)
    time.sleep(0.1)
    other({})
    publish({"data": "right"})
    time.sleep(0.2)
    assert texts(source) == ["right"]


def test_other_domains_are_others(source: ZenohSource, router: ZenohRouter) -> None:
    robot = ZenohRobot(router.endpoint, "/elsewhere", domain=7)
    robot.publisher("/words", STRING)
    other = ZenohSource(zenoh_address(router.endpoint, {"ROS_DOMAIN_ID": "7"}))
    try:
        until(lambda: "/words" in other.offers())
        assert "/words" not in source.offers()
    finally:
        other.close()
        robot.close()


def test_publishes_with_number_time_and_identity(source: ZenohSource, robot: ZenohRobot) -> None:
    result = robot.subscription("/cmd_vel", TWIST)
    advertisement = Advertisement("/cmd_vel", TWIST)
    source.graph.advertise([advertisement]).result(5)
    until(lambda: "/cmd_vel" in source.snapshot.readers)
    for speed in (1.0, 2.0):
        cdr = encode(TWIST, {"linear": {"x": speed}})
        assert source.graph.publish(advertisement, cdr).result(5) == 1
    until(lambda: len(result) == 2)
    assert [message.linear.x for message, _ in result] == [1.0, 2.0]
    numbers = [int.from_bytes(attachment[:8], "little") for _, attachment in result]
    assert numbers[1] == numbers[0] + 1
    stamp_ns = int.from_bytes(result[0][1][8:16], "little")
    assert abs(stamp_ns - time.time_ns()) < 60e9
    (own,) = [token for token in tokens_of(robot) if "/MP/" in token]
    digest = xxhash.xxh3_128_intdigest(own.encode()).to_bytes(16, "little")
    assert result[0][1][17:] == digest, "the identity is that of the token in the graph"
    source.graph.advertise([]).result(5)
    until(lambda: not [token for token in tokens_of(robot) if "/MP/" in token])


def test_calls_a_service(source: ZenohSource, robot: ZenohRobot) -> None:
    robot.service(
        "/light", SET_BOOL, lambda request: {"success": request.data, "message": "bright"}
    )
    until(lambda: source.graph.services().get("/light") == SET_BOOL)
    request = encode(f"{SET_BOOL}_Request", {"data": True})
    answer = decode(
        f"{SET_BOOL}_Response", source.graph.call("/light", SET_BOOL, request, 5).result(5)
    )
    assert (answer.success, answer.message) == (True, "bright")
    with pytest.raises(NotConnected, match=r"No node offers /none\. Start the node"):
        source.graph.call("/none", SET_BOOL, request, 0.3).result(5)
    with pytest.raises(NotConnected, match="/light has the type std_srvs/srv/SetBool, not"):
        source.graph.call("/light", "std_srvs/srv/Empty", b"", 5).result(5)


def test_a_service_that_does_not_answer(source: ZenohSource, robot: ZenohRobot) -> None:
    robot.service("/slow", SET_BOOL, lambda request: time.sleep(1.5) or {})
    until(lambda: "/slow" in source.graph.services())
    request = encode(f"{SET_BOOL}_Request", {"data": True})
    with pytest.raises(NotConnected, match="/slow did not answer in time"):
        source.graph.call("/slow", SET_BOOL, request, 0.4).result(5)


def test_reconnects_to_a_router_that_restarts() -> None:
    port = free_port()
    router = ZenohRouter(port)
    robot = ZenohRobot(router.endpoint)
    publish = robot.publisher("/words", STRING)
    source = ZenohSource(zenoh_address(router.endpoint, {}))
    try:
        want(source, "/words")
        until(lambda: source.offers().get("/words") and source.offers()["/words"].subscribers)
        router.close()
        until(lambda: not source.bridges[0].is_up)
        assert "was lost" in source.bridges[0].problem
        assert "/words" in source.offers(), "what was known holds"
        assert "the link is broken" in source.offers()["/words"].problem
        with pytest.raises(NotConnected, match="was lost"):
            source.graph.publish(Advertisement("/x", STRING), b"").result(5)
        router = ZenohRouter(port)
        until(lambda: source.bridges[0].is_up)
        until(lambda: not source.offers()["/words"].problem)
        results: list[str] = []

        def again() -> bool:
            publish({"data": "again"})
            results.extend(texts(source))
            return bool(results)

        until(again)
    finally:
        source.close()
        robot.close()
        router.close()


def test_an_unreachable_router_is_reported() -> None:
    port = free_port()
    source = ZenohSource(zenoh_address(f"tcp/127.0.0.1:{port}", {}))
    try:
        until(lambda: "Nothing listens" in source.bridges[0].problem)
        (link,) = source.bridges
        assert link.problem == f"Nothing listens on 127.0.0.1:{port}, so there is no Zenoh router."
        assert "rmw_zenohd" in link.remedy
        router = ZenohRouter(port)
        until(lambda: source.bridges[0].is_up)
        router.close()
    finally:
        source.close()


def test_finds_the_domain_in_which_the_robot_is(source: ZenohSource, router: ZenohRouter) -> None:
    robot = ZenohRobot(router.endpoint, domain=42)
    try:
        until(lambda: source.bridges[0].remarks)
        (remark,) = source.bridges[0].remarks
        assert remark == (
            "ROS_DOMAIN_ID 0 has no nodes on this network, but 42 has 1 node. "
            "Start webviz with ROS_DOMAIN_ID=42."
        )
        own = ZenohRobot(router.endpoint)
        until(lambda: not source.bridges[0].remarks)
        own.close()
    finally:
        robot.close()


def test_another_version_of_a_type_is_reported(source: ZenohSource, robot: ZenohRobot) -> None:
    robot.publisher("/words", STRING, hash=f"RIHS01_{'0' * 64}")
    until(lambda: "/words" in source.offers())
    want(source, "/words")
    until(lambda: source.bridges[0].remarks)
    assert "/words have another version of its type" in source.bridges[0].remarks[0]


def test_simulated_time_is_that_of_clock(source: ZenohSource, robot: ZenohRobot) -> None:
    assert source.clock_messages() is None
    publish = robot.publisher("/clock", "rosgraph_msgs/msg/Clock")

    def is_simulated() -> bool:
        publish({"clock": {"sec": 12, "nanosec": 5}})
        return source.clock_messages() is not None

    until(is_simulated, look_s=0.05)
    assert source.now_ns() == 12_000_000_005
