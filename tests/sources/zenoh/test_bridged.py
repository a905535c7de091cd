"""Robots behind zenoh-bridge-ros2dds, found out by their own keys."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest
from waiting import until
from zenoh_robot import BridgedRobot, ZenohRobot, ZenohRouter

from webviz.api.declared import Topic
from webviz.data.messages import decode, encode, interfaces
from webviz.panels.calling import actions_of
from webviz.sources import Advertisement, Subscription
from webviz.sources.zenoh.source import ZenohSource

STRING = "std_msgs/msg/String"
TWIST = "geometry_msgs/msg/Twist"
SET_BOOL = "std_srvs/srv/SetBool"
SPIN = "own_zenoh_msgs/action/Turn"


@pytest.fixture
def bridged(router: ZenohRouter) -> Iterator[BridgedRobot]:
    robot = BridgedRobot(router.endpoint, "robot1")
    yield robot
    robot.close()


def texts(source: ZenohSource, topic: str) -> list[str]:
    arrived = source.inbox.drain().get(topic, ())
    return [decode(STRING, raw.cdr, raw.types).data for raw in arrived]


@pytest.mark.parametrize("is_latched", [False, True])
def test_messages_come_by_the_keys_of_the_bridge(
    source: ZenohSource, bridged: BridgedRobot, is_latched: bool
) -> None:
    publish = bridged.publisher("/words", STRING, is_latched)
    publish({"data": "before"})
    until(lambda: "/robot1/words" in source.offers())
    offer = source.offers()["/robot1/words"]
    assert offer.is_latched is is_latched
    assert offer.publishers[0].label == "the bridge"
    source.want({"/robot1/words": Subscription(STRING, Topic("/robot1/words"))})
    if is_latched:
        results: list[str] = []
        until(lambda: results.extend(texts(source, "/robot1/words")) or results)
        assert results == ["before"]
    time.sleep(0.3)
    publish({"data": "after"})
    later: list[str] = []
    until(lambda: later.extend(texts(source, "/robot1/words")) or later)
    assert later == ["after"]
    assert "does not report which nodes" in source.bridges[0].limits[0]


def test_publishes_and_calls_through_the_bridge(source: ZenohSource, bridged: BridgedRobot) -> None:
    result = bridged.subscription("/cmd_vel", TWIST)
    bridged.service("/light", SET_BOOL, lambda request: {"success": request.data})
    until(lambda: "/robot1/cmd_vel" in source.snapshot.readers)
    until(lambda: source.graph.services().get("/robot1/light") == SET_BOOL)
    cdr = encode(TWIST, {"angular": {"z": 0.5}})
    assert source.graph.publish(Advertisement("/robot1/cmd_vel", TWIST), cdr).result(5) == 1
    until(lambda: result)
    assert result[0].angular.z == 0.5
    request = encode(f"{SET_BOOL}_Request", {"data": True})
    response = source.graph.call("/robot1/light", SET_BOOL, request, 5).result(5)
    assert decode(f"{SET_BOOL}_Response", response).success


def test_a_goal_through_the_bridge(source: ZenohSource, bridged: BridgedRobot) -> None:
    parts = interfaces.action(SPIN, "float32 target_yaw\n---\n---\n")
    bridged.token("AS", "/spin", SPIN)
    accept = {"accepted": True}
    bridged.service("/spin/_action/send_goal", parts.send_goal, lambda request: accept)
    bridged.service("/spin/_action/get_result", parts.get_result, lambda request: {"status": 4})
    until(lambda: "/robot1/spin" in source.snapshot.actions)
    until(lambda: "/robot1/spin/_action/feedback" in source.offers())
    assert actions_of(source.offers()) == {"/robot1/spin": SPIN}
    encoded_goal = encode(parts.goal, {"target_yaw": 1.0})
    goal = source.graph.send_goal("/robot1/spin", SPIN, encoded_goal, lambda cdr: None)
    assert goal.accepted.result(10) is True
    assert goal.result.result(10)[0] == 4


def test_two_ways_to_one_robot(source: ZenohSource, router: ZenohRouter, robot: ZenohRobot) -> None:
    bridge = BridgedRobot(router.endpoint)
    try:
        direct, through = robot.publisher("/words", STRING), bridge.publisher("/words", STRING)
        until(lambda: source.bridges[0].remarks)
        (remark,) = source.bridges[0].remarks
        assert remark.startswith("Two ways lead to one robot: /words come")
        source.want({"/words": Subscription(STRING, Topic("/words"))})
        until(lambda: source.offers()["/words"].subscribers)
        time.sleep(0.2)
        through({"data": "twice"})
        direct({"data": "twice"})
        time.sleep(0.3)
        assert texts(source, "/words") == ["twice"]
    finally:
        bridge.close()


def test_a_bridge_that_routes_nothing(source: ZenohSource, bridged: BridgedRobot) -> None:
    until(lambda: source.bridges[0].remarks)
    assert source.bridges[0].remarks[0].startswith("A zenoh-bridge-ros2dds routes nothing.")
    bridged.publisher("/words", STRING)
    until(lambda: not source.bridges[0].remarks)
