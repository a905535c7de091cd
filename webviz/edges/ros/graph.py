"""Publishers, service clients and action clients of the node."""

from __future__ import annotations

import contextlib
import logging
import time
import uuid
from collections.abc import Callable, Collection
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

from rclpy.client import Client
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from webviz.data.messages import decode, encode, interfaces
from webviz.edges.ros.jobs import Jobs
from webviz.edges.ros.types import (
    MessageTypeError,
    from_cdr,
    learn,
    message_class,
    service_class,
    to_cdr,
)
from webviz.engine.sources.graph import Goal, Missing, NotConnected, Outlet

log = logging.getLogger("webviz")

CANCEL = "action_msgs/srv/CancelGoal"
MOST_PUBLISHERS = 100
MOST_CLIENTS = 100
MOST_CALLS = 100
"""Pending service calls."""
FEEDBACK_DEPTH = 10
WAIT_S = 2.0
"""How long to wait for a service or action to appear, and for an answer that is still on its way
when the node has ended."""
GOAL_ID = slice(4, 20)
"""Of a serialised feedback message, after the encapsulation header."""


@dataclass(eq=False)
class _Call:
    """A pending service call.

    Args:
        client: of the service.
        request: its message.
        answer: receives the serialised response.
        deadline: monotonic time by which the response must arrive.
        give_up: monotonic time by which the service must appear.
        may_send: false as long as the request has to wait.
        sent: rclpy's future, None until the request is sent.
        gone: monotonic time at which the service was found missing after that.
    """

    client: Client
    request: Any
    answer: Future[bytes]
    deadline: float
    give_up: float
    may_send: Callable[[], bool] = lambda: True
    sent: Any = None
    gone: float | None = None

    @property
    def name(self) -> str:
        """Of the service, or of the action that it is a part of."""
        return self.client.service_name.partition("/_action/")[0]


class RosGraph:
    """Publishes, calls services and sends goals; see `webviz.engine.sources.Graph`.

    Args:
        node: whose thread calls `turn` often.
        wake: makes that thread call `turn` soon.
    """

    def __init__(self, node: Node, wake: Callable[[], None]) -> None:
        self._node = node
        self._jobs = Jobs(wake)
        self._publishers: dict[Outlet, Publisher] = {}
        self._advertised: frozenset[Outlet] = frozenset()
        self._clients: dict[tuple[str, str], Client] = {}
        self._subscriptions: dict[str, Subscription] = {}
        self._feedback: dict[bytes, Callable[[bytes], object]] = {}
        self._calls: list[_Call] = []
        self._nodes: tuple[str, ...] = ()

    # From any thread

    def advertise(self, outlets: Collection[Outlet]) -> Future[None]:
        """Create these publishers ahead of their first messages, and destroy the previous ones."""
        wanted = frozenset(outlets)

        def do() -> None:
            before, self._advertised = self._advertised, wanted
            for outlet in before - wanted:
                self._destroy_publisher(outlet)
            for outlet in wanted:
                with contextlib.suppress(MessageTypeError):  # reported by `publish`
                    self._publisher(outlet)

        return self._jobs.put(do)

    def publish(self, outlet: Outlet, cdr: bytes) -> Future[int]:
        """Publish a message; the number of matched subscriptions."""

        def do() -> int:
            publisher = self._publisher(outlet)
            publisher.publish(cdr)
            return publisher.get_subscription_count()

        return self._jobs.put(do)

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Call a service; the serialised response."""
        answer: Future[bytes] = Future()
        self._start(answer, lambda: self._send(service, type, request, timeout_s, answer))
        return answer

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], object]
    ) -> Goal:
        """Send a goal to an action."""
        goal_id = uuid.uuid4().bytes
        accepted: Future[bool] = Future()
        result: Future[tuple[int, bytes]] = Future()

        def cancel() -> Future[int]:
            values = {"goal_info": {"goal_id": _id(goal_id)}}
            parts = interfaces.service(CANCEL)
            request = encode(parts.request, values)
            answer = self.call(f"{action}/_action/cancel_goal", CANCEL, request, WAIT_S)
            return _then(answer, lambda cdr: int(decode(parts.response, cdr).return_code))

        sent = Goal(goal_id, accepted, result, cancel)
        self._start(accepted, lambda: self._offer(action, type, goal, sent, feedback))
        return sent

    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes of the graph, sorted."""
        return self._nodes

    # In the thread of the node

    def turn(self) -> None:
        """Run the queued jobs, and advance the pending calls."""
        self._jobs.run()
        now = time.monotonic()
        self._calls = [call for call in self._calls if not self._advance(call, now)]

    def look(self) -> None:
        """Refresh the node names."""
        names = self._node.get_node_names_and_namespaces()
        self._nodes = tuple(sorted({f"{space.rstrip('/')}/{name}" for name, space in names}))

    def close(self) -> None:
        """Fail everything that is pending."""
        self._jobs.end()
        for call in self._calls:
            call.answer.set_exception(NotConnected("The connection to ROS has ended."))
        self._calls = []

    def _start(self, answer: Future, do: Callable[[], None]) -> None:
        """Call `do` in the thread of the node, and pass its error to the answer."""

        def pass_on(started: Future[None]) -> None:
            if (error := started.exception()) and not answer.done():
                answer.set_exception(error)

        self._jobs.put(do).add_done_callback(pass_on)

    def _publisher(self, outlet: Outlet) -> Publisher:
        if outlet not in self._publishers:
            for _ in range(len(self._publishers) - MOST_PUBLISHERS + 1):
                self._destroy_publisher(next(iter(self._publishers)))
            profile = QoSProfile(
                depth=outlet.depth,
                reliability=ReliabilityPolicy[outlet.reliability.upper()],
                durability=DurabilityPolicy[outlet.durability.upper()],
            )
            self._publishers[outlet] = self._node.create_publisher(
                message_class(outlet.type), outlet.topic, profile
            )
        return self._publishers[outlet]

    def _destroy_publisher(self, outlet: Outlet) -> None:
        if publisher := self._publishers.pop(outlet, None):
            self._node.destroy_publisher(publisher)

    def _client(self, service: str, type: str) -> Client:
        if (service, type) not in self._clients:
            for _ in range(len(self._clients) - MOST_CLIENTS + 1):
                self._node.destroy_client(self._clients.pop(next(iter(self._clients))))
            self._clients[service, type] = self._node.create_client(service_class(type), service)
        return self._clients[service, type]

    def _send(
        self,
        service: str,
        type: str,
        request: bytes,
        timeout_s: float,
        answer: Future[bytes],
        may_send: Callable[[], bool] = lambda: True,
    ) -> None:
        if len(self._calls) >= MOST_CALLS:
            raise NotConnected(f"{MOST_CALLS} service calls are pending. Try again later.")
        client = self._client(service, type)
        message = from_cdr(request, service_class(type).Request)
        now = time.monotonic()
        give_up = now + min(timeout_s, WAIT_S)
        self._calls.append(_Call(client, message, answer, now + timeout_s, give_up, may_send))

    def _advance(self, call: _Call, now: float) -> bool:
        """Advance a call by one step; whether it has finished."""
        name = call.name
        is_ready = call.client.service_is_ready()
        if call.sent is None:
            if is_ready and call.may_send():
                call.sent = call.client.call_async(call.request)
            elif now > call.give_up:
                call.answer.set_exception(Missing(f"No node offers {name}."))
                return True
            return False
        if call.sent.done():
            call.answer.set_result(to_cdr(call.sent.result()))
            return True
        call.gone = None if is_ready else call.gone or now
        error = None
        if call.gone is not None and now > call.gone + WAIT_S:
            error = Missing(f"The node that offered {name} has ended.")
        elif now > call.deadline:
            error = NotConnected(f"{name} did not answer in time.")
        if error is not None:
            call.client.remove_pending_request(call.sent)
            call.answer.set_exception(error)
        return error is not None

    def _offer(
        self,
        action: str,
        type: str,
        goal: bytes,
        sent: Goal,
        feedback: Callable[[bytes], object],
    ) -> None:
        """Send a goal, and wait for its result if it is accepted."""
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
        self._send(
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
        done = self.call(f"{action}/_action/get_result", parts.get_result, request, forever)
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
