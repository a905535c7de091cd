"""A graph that remembers what is published, and goals, instead of sending them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

from webviz.data.messages import decode
from webviz.sources import Advertisement, Goal, NotConnected


@dataclass
class SentGoal:
    """A goal whose answers a test gives."""

    action: str
    type: str
    values: Any
    feedback: Callable[[bytes], object]
    accepted: Future[bool] = field(default_factory=Future)
    result: Future[tuple[int, bytes]] = field(default_factory=Future)
    cancels: list[Future[int]] = field(default_factory=list)

    def cancel(self) -> Future[int]:
        """Remember that it was asked to end."""
        self.cancels.append(Future())
        return self.cancels[-1]


@dataclass
class RememberingGraph:
    """Remembers what is published; each topic has as many subscriptions as a test says."""

    subscriptions: int = 1
    published: list[tuple[Advertisement, Any]] = field(default_factory=list)
    advertised: Collection[Advertisement] = ()
    responses: dict[str, bytes] = field(default_factory=dict)
    """Responses by service, encoded."""
    requests: list[tuple[str, str, bytes]] = field(default_factory=list)
    """Service, type and encoded request."""
    goals: list[SentGoal] = field(default_factory=list)

    def advertise(self, advertisements: Collection[Advertisement]) -> Future[None]:
        """Remember what may be published."""
        self.advertised = advertisements
        return answered(None)

    def publish(self, advertisement: Advertisement, cdr: bytes) -> Future[int]:
        """Remember a message, decoded."""
        self.published.append((advertisement, decode(advertisement.type, cdr)))
        return answered(self.subscriptions)

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Remember a request, and return the response that a test has set."""
        self.requests.append((service, type, request))
        if service in self.responses:
            return answered(self.responses[service])
        missing: Future[bytes] = Future()
        missing.set_exception(NotConnected(f"No node offers {service}. Start one."))
        return missing

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], object]
    ) -> Goal:
        """Remember a goal, whose answers a test gives."""
        goal_sent = SentGoal(action, type, decode(f"{type}_Goal", goal), feedback)
        self.goals.append(goal_sent)
        return Goal(bytes(16), goal_sent.accepted, goal_sent.result, goal_sent.cancel)

    def nodes(self) -> tuple[str, ...]:
        """Return no nodes."""
        return ()

    def services(self) -> Mapping[str, str]:
        """Return no services."""
        return {}


def answered(result: Any) -> Future[Any]:
    """Return a future with a result."""
    future: Future[Any] = Future()
    future.set_result(result)
    return future
