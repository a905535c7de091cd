"""Goals, parameters and definitions over Zenoh."""

from __future__ import annotations

import threading
from concurrent.futures import Future

import pytest
from waiting import until
from zenoh_robot import ZenohRobot

from webviz.api.declared import Topic
from webviz.data.messages import decode, encode, interfaces, type_exists
from webviz.sources import NotConnected, Subscription
from webviz.sources.zenoh import descriptions
from webviz.sources.zenoh.source import ZenohSource

SPIN = "own_zenoh_msgs/action/Spin"
SPIN_TEXT = """float32 target_yaw
---
builtin_interfaces/Duration total_elapsed_time
---
float32 angular_distance_traveled
"""
DESCRIBE = "type_description_interfaces/srv/GetTypeDescription"


@pytest.fixture(autouse=True)
def spin() -> None:
    interfaces.action(SPIN, SPIN_TEXT)


def test_a_goal_from_acceptance_to_result(source: ZenohSource, robot: ZenohRobot) -> None:
    released = threading.Event()

    def run(goal: object, feedback: object) -> dict[str, object]:
        feedback(angular_distance_traveled=0.5)  # type: ignore[operator]
        released.wait(10)
        return {"total_elapsed_time": {"sec": 3}}

    calls = robot.action("/spin", SPIN, run)
    until(lambda: "/spin/_action/get_result" in source.snapshot.servers)
    assert "/spin/_action/send_goal" not in source.graph.services(), "parts are not listed"
    parts = interfaces.action(SPIN)
    feedback_values: list[float] = []

    def feedback(cdr: bytes) -> None:
        feedback_values.append(decode(parts.feedback, cdr).feedback.angular_distance_traveled)

    goal = source.graph.send_goal("/spin", SPIN, encode(parts.goal, {"target_yaw": 1.0}), feedback)
    assert goal.accepted.result(10) is True
    until(lambda: feedback_values == [0.5])
    assert not goal.result.done()
    assert goal.cancel().result(10) == 0
    released.set()
    status, cdr = goal.result.result(10)
    assert status == 4
    assert decode(f"{parts.get_result}_Response", cdr).result.total_elapsed_time.sec == 3
    assert calls == {"send_goal": 1, "cancel_goal": 1, "get_result": 1}


def test_a_goal_that_is_rejected(source: ZenohSource, robot: ZenohRobot) -> None:
    robot.action("/spin", SPIN, lambda goal, feedback: {})
    until(lambda: "/spin/_action/get_result" in source.snapshot.servers)
    encoded_goal = encode(interfaces.action(SPIN).goal, {"target_yaw": -1.0})
    goal = source.graph.send_goal("/spin", SPIN, encoded_goal, lambda cdr: None)
    assert goal.accepted.result(10) is False
    with pytest.raises(NotConnected, match="/spin rejected the goal"):
        goal.result.result(10)


def test_a_goal_without_a_server(source: ZenohSource) -> None:
    encoded_goal = encode(interfaces.action(SPIN).goal, {})
    goal = source.graph.send_goal("/nobody", SPIN, encoded_goal, lambda cdr: None)
    with pytest.raises(NotConnected, match="No node offers /nobody"):
        goal.accepted.result(10)


def test_parameters_are_services(source: ZenohSource, robot: ZenohRobot) -> None:
    type = "rcl_interfaces/srv/GetParameters"
    robot.service(
        "/robot/get_parameters",
        type,
        lambda request: {"values": [{"type": 3, "double_value": 0.5} for _ in request.names]},
    )
    until(lambda: source.graph.services().get("/robot/get_parameters") == type)
    request = encode(f"{type}_Request", {"names": ["max_speed"]})
    answered: Future[bytes] = source.graph.call("/robot/get_parameters", type, request, 5)
    (value,) = decode(f"{type}_Response", answered.result(5)).values
    assert value.double_value == 0.5


def test_definitions_come_from_the_publisher(source: ZenohSource, robot: ZenohRobot) -> None:
    type = "own_zenoh_msgs/msg/Wheel"
    assert not type_exists(type)
    interfaces.learn(DESCRIBE, descriptions.REQUEST, descriptions.RESPONSE)
    sources = [
        {
            "type_name": type,
            "encoding": "msg",
            "raw_file_contents": "# Of a wheel.\nTyre tyre\nfloat64 speed\n",
        },
        {
            "type_name": "own_zenoh_msgs/msg/Tyre",
            "encoding": "msg",
            "raw_file_contents": "uint8 wear",
        },
    ]
    publish = robot.publisher("/wheel", type, hash=f"RIHS01_{'ab' * 32}")
    until(lambda: "/wheel" in source.offers())
    source.want({"/wheel": Subscription(type, Topic("/wheel"))})
    until(lambda: source.offers()["/wheel"].problem)
    assert "its publisher does not provide it" in source.offers()["/wheel"].problem
    robot.service(
        "/robot/get_type_description",
        DESCRIBE,
        lambda request: {
            "successful": request.type_name == type,
            "type_sources": sources if request.include_type_sources else [],
        },
    )
    until(lambda: not source.offers()["/wheel"].problem)
    cdr = bytes([0, 1, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0]) + b"\0\0\0\0\0\0\x04\x40"
    source.inbox.drain()
    publish(cdr)
    (raw,) = until(lambda: source.inbox.drain().get("/wheel"))
    wheel = decode(type, raw.cdr, raw.types)
    assert (wheel.tyre.wear, wheel.speed) == (7, 2.5)
