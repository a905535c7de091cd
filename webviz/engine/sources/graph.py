"""What a source can do besides reading: publish, call services, send goals to actions."""

from __future__ import annotations

from collections.abc import Callable, Collection
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Literal, Protocol

from webviz.api.errors import Error

Reliability = Literal["reliable", "best_effort"]
Durability = Literal["volatile", "transient_local"]


class NotConnected(Error):
    """A source cannot act, or the other side is missing; one sentence says why and what to do."""


@dataclass(frozen=True)
class Outlet:
    """Where messages go: a topic with its type and the QoS that is offered.

    Args:
        topic: fully resolved name.
        type: message type, such as "geometry_msgs/msg/PoseStamped".
        reliability, durability, depth: what subscriptions may ask for.
    """

    topic: str
    type: str
    reliability: Reliability = "reliable"
    durability: Durability = "volatile"
    depth: int = 5


@dataclass(frozen=True)
class Goal:
    """A goal that was sent to an action.

    Args:
        id: 16 bytes.
        accepted: whether the server takes it on.
        result: status of action_msgs/msg/GoalStatus, and the serialised
            `<action>_GetResult_Response`.
        cancel: asks the server to stop; the result tells what came of it.
    """

    id: bytes
    accepted: Future[bool]
    result: Future[tuple[int, bytes]]
    cancel: Callable[[], None]


class Graph(Protocol):
    """Everything may be called from any thread and returns at once.

    Futures raise `NotConnected`. Bytes are CDR with the encapsulation header.
    """

    def advertise(self, outlets: Collection[Outlet]) -> Future[None]:
        """Make the advertised publishers exactly these.

        Subscriptions match an advertised publisher before its first message.
        """
        ...

    def publish(self, outlet: Outlet, cdr: bytes) -> Future[int]:
        """Publish a message; how many subscriptions the publisher is matched with."""
        ...

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Call a service; the serialised response."""
        ...

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], None]
    ) -> Goal:
        """Send a goal to an action.

        Args:
            action: fully resolved name.
            type: such as "nav2_msgs/action/NavigateToPose".
            goal: serialised `<type>_Goal`.
            feedback: gets each serialised `<type>_FeedbackMessage` of this goal, in another thread;
                must not block.
        """
        ...

    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes of the graph, sorted."""
        ...


class ReadOnly:
    """The graph of a source that only reads.

    Args:
        reason: why, and what to do; one sentence.
    """

    def __init__(self, reason: str) -> None:
        self._reason = reason

    def advertise(self, outlets: Collection[Outlet]) -> Future[None]:
        """Refuse."""
        return _failed(self._reason)

    def publish(self, outlet: Outlet, cdr: bytes) -> Future[int]:
        """Refuse."""
        return _failed(self._reason)

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Refuse."""
        return _failed(self._reason)

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], None]
    ) -> Goal:
        """Refuse."""
        return Goal(b"", _failed(self._reason), _failed(self._reason), lambda: None)

    def nodes(self) -> tuple[str, ...]:
        """None."""
        return ()


def _failed(reason: str) -> Future:
    future: Future = Future()
    future.set_exception(NotConnected(reason))
    return future
