"""Output through a source: publishing, service calls and action goals."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from concurrent.futures import Future
from typing import Protocol

import msgspec

from webviz.api.errors import Error
from webviz.api.offer import Durability, Reliability
from webviz.data.words import joined

UNKNOWN = -1
"""The number of matched subscriptions, if the other side does not tell it."""


class NotConnected(Error):
    """A source cannot send, or the other side is missing; one sentence with a remedy."""


class Missing(NotConnected):
    """No node offers a service or action, or the one that did has ended.

    Args:
        cause: one sentence, without a remedy.
    """

    def __init__(self, cause: str) -> None:
        super().__init__(joined(cause, "Start the node, or choose another name."))
        self.cause = cause


class Advertisement(msgspec.Struct, frozen=True):
    """A topic to publish, with its type and the offered QoS.

    Args:
        topic: full name.
        type: message type, such as "geometry_msgs/msg/PoseStamped".
        reliability, durability, depth: offered to subscriptions.
    """

    topic: str
    type: str
    reliability: Reliability = "reliable"
    durability: Durability = "volatile"
    depth: int = 5


class Goal(msgspec.Struct, frozen=True):
    """A goal that was sent to an action.

    Args:
        id: 16 bytes.
        accepted: whether the server accepts it.
        result: status of action_msgs/msg/GoalStatus, and the serialised
            `<action>_GetResult_Response`.
        cancel: asks the server to stop, and returns the return code of action_msgs/srv/CancelGoal;
            `result` has the outcome.
    """

    id: bytes
    accepted: Future[bool]
    result: Future[tuple[int, bytes]]
    cancel: Callable[[], Future[int]]


class Graph(Protocol):
    """All methods may be called from any thread and return at once.

    Futures raise `NotConnected`. Bytes are CDR with the encapsulation header.
    """

    def advertise(self, advertisements: Collection[Advertisement]) -> Future[None]:
        """Make the advertised publishers exactly these.

        Subscriptions match an advertised publisher before its first message.
        """
        ...

    def publish(self, advertisement: Advertisement, cdr: bytes) -> Future[int]:
        """Publish a message; the number of matched subscriptions, or `UNKNOWN`."""
        ...

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Call a service; the serialised response."""
        ...

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], object]
    ) -> Goal:
        """Send a goal to an action.

        Args:
            action: full name.
            type: such as "nav2_msgs/action/NavigateToPose".
            goal: serialised `<type>_Goal`.
            feedback: called with each serialised `<type>_FeedbackMessage` of this goal, from
                another thread; must not block.
        """
        ...

    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes of the graph, sorted; one for each node of the name."""
        ...

    def services(self) -> Mapping[str, str]:
        """Types of the services of the graph by name, as far as they are known."""
        ...


class ReadOnly:
    """The graph of a read-only source.

    Args:
        reason: why, and a remedy; one sentence.
    """

    def __init__(self, reason: str) -> None:
        self.reason = reason

    def advertise(self, advertisements: Collection[Advertisement]) -> Future[None]:
        """Refuse."""
        return _failed(self.reason)

    def publish(self, advertisement: Advertisement, cdr: bytes) -> Future[int]:
        """Refuse."""
        return _failed(self.reason)

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Refuse."""
        return _failed(self.reason)

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], object]
    ) -> Goal:
        """Refuse."""
        refused = _failed(self.reason)
        return Goal(b"", refused, refused, lambda: refused)

    def nodes(self) -> tuple[str, ...]:
        """None."""
        return ()

    def services(self) -> Mapping[str, str]:
        """None."""
        return {}


def _failed(reason: str) -> Future:
    future: Future = Future()
    future.set_exception(NotConnected(reason))
    return future
