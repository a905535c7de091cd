"""Output of the ROS node: messages, service calls and goals, to real nodes over DDS."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import Future
from typing import Any

import pytest
from waiting import until

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from nodes import SpunNode
from std_msgs.msg import String
from std_srvs.srv import SetBool

from webviz.data.messages import decode, encode, interfaces
from webviz.ros.node import RosSource
from webviz.ros.types import MessageTypeError, learn, message_class
from webviz.ros.types.classes import composed_service
from webviz.sources import Advertisement, NotConnected, ReadOnly

STRING = "std_msgs/msg/String"
FIBONACCI = "test_msgs/action/Fibonacci"
SUCCEEDED, CANCELED = 4, 5  # of action_msgs/msg/GoalStatus
TERMINATED = 3  # of action_msgs/srv/CancelGoal

ACTION_SERVER = """
import time
import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.signals import SignalHandlerOptions
from test_msgs.action import Fibonacci

def execute(handle):
    sequence = [0, 1]
    while len(sequence) < handle.request.order:
        if handle.is_cancel_requested:
            handle.canceled()
            return Fibonacci.Result(sequence=sequence)
        sequence.append(sequence[-1] + sequence[-2])
        handle.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        time.sleep(0.05)
    handle.succeed()
    return Fibonacci.Result(sequence=sequence)

def judge(request):
    return GoalResponse.ACCEPT if request.order > 0 else GoalResponse.REJECT

rclpy.init(signal_handler_options=SignalHandlerOptions.NO)  # it ends at once
node = rclpy.create_node("counter")
server = ActionServer(
    node, Fibonacci, "/count", execute, goal_callback=judge,
    cancel_callback=lambda _: CancelResponse.ACCEPT, callback_group=ReentrantCallbackGroup(),
)
executor = MultiThreadedExecutor()
executor.add_node(node)
print("ready", flush=True)
executor.spin()
"""


@pytest.fixture(scope="module")
def peer(webviz_domain: int) -> Iterator[SpunNode]:
    peer = SpunNode(webviz_domain, "peer")
    yield peer
    peer.close()


@pytest.fixture(scope="module")
def source(webviz_domain: int) -> Iterator[RosSource]:
    source = RosSource(domain_id=webviz_domain)
    yield source
    source.close()


@pytest.fixture(scope="module")
def counter(webviz_domain: int, source: RosSource) -> Iterator[None]:
    pytest.importorskip("test_msgs", reason="needs test_msgs: install ros-webviz[ros-test]")
    env = os.environ | {"ROS_DOMAIN_ID": str(webviz_domain)}
    process = subprocess.Popen(
        [sys.executable, "-c", ACTION_SERVER], env=env, stdout=subprocess.PIPE
    )
    assert process.stdout is not None
    process.stdout.readline()
    until(lambda: "/counter" in source.graph.nodes())
    yield
    process.terminate()
    process.communicate()


def order(number: int) -> bytes:
    learn(FIBONACCI)
    return encode(f"{FIBONACCI}_Goal", {"order": number})


def test_a_message_reaches_a_subscription_that_knew_the_publisher(
    source: RosSource, peer: SpunNode
) -> None:
    texts: list[str] = []

    def hear(message: String) -> None:
        texts.append(message.data)

    peer.node.create_subscription(String, "/said", hear, 10)
    advertisement = Advertisement("/said", STRING)
    source.graph.advertise([advertisement]).result(30.0)
    peer.until(lambda: peer.node.count_publishers("/said"))
    hello = encode(STRING, {"data": "hello"})
    peer.until(lambda: source.graph.publish(advertisement, hello).result(30.0) == 1)
    peer.until(lambda: "hello" in texts)


def test_the_publisher_of_an_unadvertised_topic_is_destroyed(
    source: RosSource, peer: SpunNode
) -> None:
    old, new = Advertisement("/old_goal", STRING), Advertisement("/new_goal", STRING)
    unknown = Advertisement("/unknown_goal", "no_msgs/msg/No")
    source.graph.advertise([old]).result(30.0)
    peer.until(lambda: peer.node.count_publishers("/old_goal"))
    source.graph.advertise([unknown, new]).result(30.0)
    peer.until(lambda: peer.node.count_publishers("/new_goal"))
    peer.until(lambda: not peer.node.count_publishers("/old_goal"))


def test_publishing_does_not_wait_for_incoming_messages(
    webviz_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.ros.node.LOOK_S", 3600.0)
    source = RosSource(domain_id=webviz_domain)
    advertisement = Advertisement("/lonely", STRING)
    for _ in range(5):
        assert source.graph.publish(advertisement, encode(STRING)).result(60.0) == 0
    monkeypatch.undo()
    source.graph.publish(advertisement, encode(STRING)).result(60.0)  # begins another wait
    source.close()


def test_publishing_without_a_subscription_is_reported(source: RosSource) -> None:
    assert source.graph.publish(Advertisement("/lonely", STRING), encode(STRING)).result(30.0) == 0


def test_an_unknown_type_is_refused_and_the_node_goes_on(source: RosSource) -> None:
    failed = source.graph.publish(Advertisement("/unknown", "no_msgs/msg/No"), b"")
    with pytest.raises(MessageTypeError, match="Install its package"):
        failed.result(30.0)
    assert source.graph.publish(Advertisement("/lonely", STRING), encode(STRING)).result(30.0) == 0


def test_a_service_answers(source: RosSource, peer: SpunNode) -> None:
    def answer(request: Any, response: Any) -> Any:
        response.success, response.message = request.data, "done"
        return response

    peer.node.create_service(SetBool, "/switch", answer)
    interfaces.service("std_srvs/srv/SetBool")
    request = encode("std_srvs/srv/SetBool_Request", {"data": True})
    future: Future[bytes] = source.graph.call("/switch", "std_srvs/srv/SetBool", request, 10.0)
    peer.until(future.done)
    response = decode("std_srvs/srv/SetBool_Response", future.result())
    assert (response.success, response.message) == (True, "done")
    peer.until(lambda: source.graph.services().get("/switch") == "std_srvs/srv/SetBool")


def test_a_service_that_no_node_offers_is_named(source: RosSource) -> None:
    interfaces.service("std_srvs/srv/Trigger")
    request = encode("std_srvs/srv/Trigger_Request")
    future = source.graph.call("/nowhere", "std_srvs/srv/Trigger", request, 10.0)
    with pytest.raises(NotConnected, match="No node offers /nowhere"):
        future.result(10.0)


@pytest.mark.usefixtures("counter")
def test_a_goal_gets_feedback_and_its_result(source: RosSource) -> None:
    feedback: list[bytes] = []
    goal = source.graph.send_goal("/count", FIBONACCI, order(6), feedback.append)
    assert goal.accepted.result(60.0)
    status, result = goal.result.result(60.0)
    assert status == SUCCEEDED
    sequence = decode(f"{FIBONACCI}_GetResult_Response", result).result.sequence
    assert list(sequence) == [0, 1, 1, 2, 3, 5]
    last = decode(f"{FIBONACCI}_FeedbackMessage", feedback[-1])
    assert bytes(last.goal_id.uuid) == goal.id
    assert list(last.feedback.sequence)[:3] == [0, 1, 1]


@pytest.mark.usefixtures("counter")
def test_a_goal_can_be_cancelled(source: RosSource) -> None:
    goal = source.graph.send_goal("/count", FIBONACCI, order(40), lambda _: goal.cancel())
    assert goal.result.result(60.0)[0] == CANCELED
    assert goal.cancel().result(60.0) == TERMINATED


@pytest.mark.usefixtures("counter")
def test_a_rejected_goal_is_reported(source: RosSource) -> None:
    goal = source.graph.send_goal("/count", FIBONACCI, order(-1), lambda _: None)
    assert goal.accepted.result(60.0) is False
    with pytest.raises(NotConnected, match="/count rejected the goal"):
        goal.result.result(30.0)


FOLLOW = "nav2_msgs/action/FollowWaypoints"
MALFORMED = b"\0\1\0\0"
ACCEPTED = b"\0\1\0\0\1\0\0\0" + bytes(8)
SUCCESS = b"\0\1\0\0\4\0\0\0"


def offer(peer: SpunNode, action: str, answers: dict[str, bytes]) -> dict[str, int]:
    """Offer an action that gives these answers, whatever they are; counts requests by service."""
    interfaces.action(FOLLOW)
    requests = dict.fromkeys(answers, 0)
    for name, type, part in (
        ("send_goal", f"{FOLLOW}_SendGoal", "send_goal"),
        ("get_result", f"{FOLLOW}_GetResult", "get_result"),
        ("cancel_goal", "action_msgs/srv/CancelGoal", "cancel_goal"),
    ):
        cls = composed_service(type)

        def answer(_: Any, response: Any, part: str = part, cls: Any = cls) -> Any:
            requests[part] += 1
            return cls.Response(answers[part])

        peer.node.create_service(cls, f"{action}/_action/{name}", answer)
    feedback = message_class(f"{FOLLOW}_FeedbackMessage")
    peer.node.create_publisher(feedback, f"{action}/_action/feedback", 1)
    return requests


def test_a_malformed_answer_to_a_goal_ends_and_cancels_it(
    source: RosSource, peer: SpunNode
) -> None:
    answers = {"send_goal": MALFORMED, "get_result": MALFORMED, "cancel_goal": MALFORMED}
    requests = offer(peer, "/liar", answers)
    goal = source.graph.send_goal("/liar", FOLLOW, encode(f"{FOLLOW}_Goal"), lambda _: None)
    peer.until(lambda: goal.accepted.done() and requests["cancel_goal"])
    for future in (goal.accepted, goal.result):
        with pytest.raises(NotConnected, match=r"An answer of /liar cannot be read: .* Correct"):
            future.result(0.0)


@pytest.mark.parametrize("result", [MALFORMED, SUCCESS, SUCCESS + b"\1\2"])
def test_a_truncated_result_ends_a_goal(source: RosSource, peer: SpunNode, result: bytes) -> None:
    action = f"/truncated_{len(result)}"
    answers = {"send_goal": ACCEPTED, "get_result": result, "cancel_goal": MALFORMED}
    offer(peer, action, answers)
    goal = source.graph.send_goal(action, FOLLOW, encode(f"{FOLLOW}_Goal"), lambda _: None)
    peer.until(goal.result.done)
    assert goal.accepted.result(0.0)
    with pytest.raises(NotConnected, match=f"An answer of {action} cannot be read"):
        goal.result.result(0.0)


def test_a_goal_without_observers_frees_its_place(
    source: RosSource, peer: SpunNode, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.ros.calls.MAX_CALLS", 2)
    peer.node.create_service(SetBool, "/waiting", lambda _, response: response)
    request = encode("std_srvs/srv/SetBool_Request")
    first = source.graph.call("/waiting", "std_srvs/srv/SetBool", request, 60.0)
    peer.until(first.done)
    for _ in range(5):  # the peer is not spun, so that none is answered
        answer = source.graph.call("/waiting", "std_srvs/srv/SetBool", request, 600.0)
        assert answer.cancel()
        assert (
            source.graph.publish(Advertisement("/lonely", STRING), encode(STRING)).result(30.0) == 0
        )
    pending = source.graph.call("/waiting", "std_srvs/srv/SetBool", request, 600.0)
    peer.until(pending.done)
    assert pending.exception(0.0) is None


def test_a_graph_that_only_reads_refuses_in_one_sentence() -> None:
    graph = ReadOnly("A bag can only be read.")
    goal = graph.send_goal("/count", FIBONACCI, b"", lambda _: None)
    futures: list[Future[Any]] = [
        graph.publish(Advertisement("/a", STRING), b""),
        graph.call("/b", "", b"", 1.0),
        goal.accepted,
    ]
    for future in futures:
        with pytest.raises(NotConnected, match="A bag can only be read"):
            future.result(1.0)


def test_pending_calls_are_refused_when_the_node_ends(webviz_domain: int) -> None:
    source = RosSource(domain_id=webviz_domain)
    interfaces.service("std_srvs/srv/Trigger")
    request = encode("std_srvs/srv/Trigger_Request")
    future = source.graph.call("/nowhere", "std_srvs/srv/Trigger", request, 60.0)
    source.close()
    with pytest.raises(NotConnected, match="has ended"):
        future.result(30.0)
    with pytest.raises(NotConnected, match="has ended"):
        source.graph.publish(Advertisement("/said", STRING), b"").result(30.0)
