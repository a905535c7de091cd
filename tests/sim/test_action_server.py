"""The simulator's action server, with rclpy's own client."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed", exc_type=ImportError)
pytest.importorskip("test_msgs", reason="needs test_msgs: install ros-webviz[ros-test]")

from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal
from nodes import SpunNode
from rclpy.action.client import ActionClient
from rclpy.experimental.events_executor import EventsExecutor
from test_msgs.action import Fibonacci

from webviz.ros.types import learn
from webviz_sim.action_server import MAX_ENDED, ActionServer, ServerGoal

pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

FIBONACCI = "test_msgs/action/Fibonacci"


class FibonacciNode(SpunNode):
    """A server that accepts positive orders, and a client."""

    def __init__(self, domain: int) -> None:
        super().__init__(domain, "fibonacci", EventsExecutor)
        self.begun: list[ServerGoal] = []
        learn(FIBONACCI)
        ActionServer(self.node, "/count", FIBONACCI, lambda goal: goal.order > 0, self.begun.append)
        self.client = ActionClient(self.node, Fibonacci, "/count")
        self.until(self.client.server_is_ready)

    def result_of(self, future: Any) -> Any:
        self.until(future.done)
        return future.result()

    def send(self, order: int, hear: Callable[[Any], None] = lambda _: None) -> Any:
        goal = Fibonacci.Goal(order=order)
        return self.result_of(self.client.send_goal_async(goal, hear))


@pytest.fixture(scope="module")
def bench(webviz_domain: int) -> Iterator[FibonacciNode]:
    bench = FibonacciNode(webviz_domain)
    yield bench
    bench.client.destroy()
    bench.close()


def test_a_client_gets_feedback_and_the_result_when_the_goal_ends(bench: FibonacciNode) -> None:
    feedback: list[Any] = []
    handle = bench.send(3, feedback.append)
    assert handle.accepted
    goal = bench.begun[-1]
    assert goal.request.order == 3
    ended = handle.get_result_async()
    goal.report({"sequence": [0, 1]})
    bench.until(lambda: feedback)
    assert list(feedback[0].feedback.sequence) == [0, 1]
    assert not ended.done()
    goal.succeed({"sequence": [0, 1, 1]})
    outcome = bench.result_of(ended)
    assert outcome.status == GoalStatus.STATUS_SUCCEEDED
    assert list(outcome.result.sequence) == [0, 1, 1]
    # A result is kept for those who ask later, but not for ever.
    assert bench.result_of(handle.get_result_async()).status == GoalStatus.STATUS_SUCCEEDED
    for _ in range(MAX_ENDED):
        bench.send(1)
        bench.begun[-1].abort({})
    assert bench.result_of(handle.get_result_async()).status == GoalStatus.STATUS_UNKNOWN


def test_a_goal_can_be_rejected_and_cancelled(bench: FibonacciNode) -> None:
    assert not bench.send(0).accepted
    handle = bench.send(2)
    goal = bench.begun[-1]
    ended = handle.get_result_async()
    assert bench.result_of(handle.cancel_goal_async()).return_code == 0
    assert goal.is_canceling
    goal.cancel({"sequence": [5]})
    outcome = bench.result_of(ended)
    assert (outcome.status, list(outcome.result.sequence)) == (GoalStatus.STATUS_CANCELED, [5])
    response = bench.result_of(handle.cancel_goal_async())
    assert response.return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED


def test_a_request_without_an_id_cancels_all_goals(bench: FibonacciNode) -> None:
    handles = [bench.send(order) for order in (4, 5)]
    cancel = bench.node.create_client(CancelGoal, "/count/_action/cancel_goal")
    answer = bench.result_of(cancel.call_async(CancelGoal.Request()))
    assert len(answer.goals_canceling) == 2
    for goal in bench.begun[-2:]:
        assert goal.is_canceling
        goal.cancel({})
    for handle in handles:
        assert bench.result_of(handle.get_result_async()).status == GoalStatus.STATUS_CANCELED


def test_a_goal_with_the_id_of_another_is_rejected_and_leaves_it_alone(
    bench: FibonacciNode,
) -> None:
    handle = bench.send(2)
    goal, count = bench.begun[-1], len(bench.begun)
    # rclpy's client refuses to send an id twice.
    send = bench.node.create_client(Fibonacci.Impl.SendGoalService, "/count/_action/send_goal")
    request = Fibonacci.Impl.SendGoalService.Request(
        goal_id=handle.goal_id, goal=Fibonacci.Goal(order=7)
    )
    assert not bench.result_of(send.call_async(request)).accepted
    assert len(bench.begun) == count
    goal.succeed({"sequence": [2]})
    assert list(bench.result_of(handle.get_result_async()).result.sequence) == [2]
    bench.node.destroy_client(send)
