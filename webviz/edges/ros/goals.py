"""The action clients of the node."""

from __future__ import annotations

import logging
import uuid
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

from webviz.data.messages import decode, encode, interfaces
from webviz.edges.ros.calls import WAIT_S, Calls
from webviz.edges.ros.types import learn, message_class
from webviz.engine.sources.graph import Goal, NotConnected

log = logging.getLogger("webviz")

CANCEL = "action_msgs/srv/CancelGoal"
FEEDBACK_DEPTH = 10
GOAL_ID = slice(4, 20)
"""Of a serialised feedback message, after the encapsulation header."""
Call = Callable[[str, str, bytes, float], Future[bytes]]
"""Calls a service from any thread: its name, type, request and time limit; the response."""


class Goals:
    """Sends goals and follows them.

    Args:
        node: that has the subscriptions to feedback.
        calls: for the node's thread.
        call: for any thread.
    """

    def __init__(self, node: Node, calls: Calls, call: Call) -> None:
        self._node = node
        self._calls = calls
        self._call = call
        self._subscriptions: dict[str, Subscription] = {}
        self._feedback: dict[bytes, Callable[[bytes], object]] = {}

    def new(self, action: str) -> Goal:
        """A goal that is not sent yet."""
        goal_id = uuid.uuid4().bytes

        def cancel() -> Future[int]:
            values = {"goal_info": {"goal_id": _id(goal_id)}}
            parts = interfaces.service(CANCEL)
            request = encode(parts.request, values)
            answer = self._call(f"{action}/_action/cancel_goal", CANCEL, request, WAIT_S)
            return _then(answer, lambda cdr: int(decode(parts.response, cdr).return_code))

        return Goal(goal_id, Future(), Future(), cancel)

    def send(
        self,
        action: str,
        type: str,
        goal: bytes,
        sent: Goal,
        feedback: Callable[[bytes], object],
    ) -> None:
        """Send a goal, and wait for its result if it is accepted. In the node's thread."""
        learn(type)
        parts = interfaces.action(type)
        values = {"goal_id": _id(sent.id), "goal": decode(parts.goal, goal)}
        request = encode(f"{parts.send_goal}_Request", values)
        subscription = self._subscribe(action, parts.feedback)
        self._feedback[sent.id] = feedback
        answer: Future[bytes] = Future()

        def on_answer(answered: Future[bytes]) -> None:
            if error := answered.exception():
                self._feedback.pop(sent.id, None)
                sent.result.set_exception(error)
                sent.accepted.set_exception(error)
                return
            is_accepted = decode(f"{parts.send_goal}_Response", answered.result()).accepted
            if is_accepted:
                self._await(action, parts, sent)
            else:
                self._feedback.pop(sent.id, None)
                sent.result.set_exception(NotConnected(f"{action} rejected the goal."))
            sent.accepted.set_result(bool(is_accepted))

        answer.add_done_callback(on_answer)
        self._calls.send(
            f"{action}/_action/send_goal",
            parts.send_goal,
            request,
            WAIT_S * 5,
            answer,
            lambda: subscription.get_publisher_count() > 0,  # lose no feedback
        )

    def _await(self, action: str, parts: interfaces.Action, sent: Goal) -> None:
        request = encode(f"{parts.get_result}_Request", {"goal_id": _id(sent.id)})

        def on_result(answered: Future[bytes]) -> None:
            self._feedback.pop(sent.id, None)
            if error := answered.exception():
                sent.result.set_exception(error)
            else:
                status = decode(f"{parts.get_result}_Response", answered.result()).status
                sent.result.set_result((int(status), answered.result()))

        forever = float("inf")
        done = self._call(f"{action}/_action/get_result", parts.get_result, request, forever)
        done.add_done_callback(on_result)

    def _subscribe(self, action: str, type: str) -> Subscription:
        """The subscription to the feedback of all goals of an action."""
        topic = f"{action}/_action/feedback"
        if topic in self._subscriptions:
            return self._subscriptions[topic]

        def arrive(cdr: bytes) -> None:
            listener = self._feedback.get(cdr[GOAL_ID])
            if listener is not None:
                try:
                    listener(cdr)
                except Exception:  # in the tool that sent the goal; keep the node running
                    log.exception("Feedback of %s could not be handled", action)

        self._subscriptions[topic] = self._node.create_subscription(
            message_class(type), topic, arrive, QoSProfile(depth=FEEDBACK_DEPTH), raw=True
        )
        return self._subscriptions[topic]


def _then(future: Future[bytes], read: Callable[[bytes], int]) -> Future[int]:
    """A future of what `read` makes of the result of another one."""
    then: Future[int] = Future()

    def finish(done: Future[bytes]) -> None:
        try:
            then.set_result(read(done.result()))
        except Exception as error:
            then.set_exception(error)

    future.add_done_callback(finish)
    return then


def _id(goal_id: bytes) -> dict[str, Any]:
    return {"uuid": list(goal_id)}
