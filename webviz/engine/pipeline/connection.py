"""The topics and services of a display that follows a protocol of its own."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from typing import Any, TypeVar

import msgspec

from webviz.api.connection import ReceivedMessages
from webviz.api.declared import Topic
from webviz.data.messages import encode, interfaces
from webviz.engine.pipeline.services import DisplayServices
from webviz.sources import Advertisement, Offer, Raw, RestrictedGraph, Subscription

T = TypeVar("T")

LIMIT = 1000
"""Messages of a topic that wait for the display."""
MAX_BYTES = 64 << 20
"""Limit in bytes of these messages; the newest is kept, however large, if it is the only one."""


class _Line(msgspec.Struct):
    """A topic that is listened to.

    Args:
        subscription: to it.
        waiting: messages since the display listened last.
        has_gap: whether messages before these were missed.
        is_open: whether messages are kept.
    """

    subscription: Subscription
    waiting: deque[bytes] = msgspec.field(default_factory=deque)
    has_gap: bool = True
    is_open: bool = True


class DisplayConnection:
    """Implements `webviz.api.connection.GraphConnection` for one display.

    Args:
        services: with a graph.
        graph: of the services.
    """

    def __init__(self, services: DisplayServices, graph: RestrictedGraph) -> None:
        self._services = services
        self._graph = graph
        self._offers: Mapping[str, Offer] = {}
        self._lines: dict[str, _Line] = {}
        self._advertisements: dict[str, Advertisement] = {}
        self._named: set[str] = set()
        self._jobs: list[Future[Any]] = []

    # For the display

    @property
    def clock_s(self) -> float:
        """Monotonic time in seconds."""
        return self._services.clock()

    @property
    def node(self) -> str:
        """Full name of the viewer's node."""
        return self._services.resolve("~/node").rpartition("/")[0]

    def listen(self, topic: str, type: str, depth: int) -> ReceivedMessages:
        """Return the events on a topic since the last call; see `GraphConnection.listen`."""
        name = self._services.resolve(topic)
        self._named.add(name)
        subscription = Subscription(type, Topic(name, "reliable", "volatile", depth))
        line = self._lines.get(name)
        if line is None or line.subscription != subscription:
            line = self._lines[name] = _Line(subscription)
        offer = self._offers.get(name)
        publishers = [each for each in (offer.publishers if offer else ()) if each.type == type]
        received = ReceivedMessages(
            messages=tuple(line.waiting),
            publishers=tuple(each.label for each in publishers),
            endpoints=frozenset(each.endpoint for each in publishers),
            is_ready=bool(offer and offer.requested and offer.type == type),
            has_gap=line.has_gap,
            is_recorded=bool(offer and offer.is_recorded),
        )
        line.waiting.clear()
        line.has_gap, line.is_open = False, True
        return received

    def query(
        self, service: str, type: str, timeout_s: float, request: Mapping[str, Any] | None = None
    ) -> Future[bytes]:
        """Call a service that changes nothing; see `GraphConnection.listen`."""
        name = self._services.resolve(service)
        data = encode(interfaces.service(type).request, request or {})
        answer = self._graph.query(name, type, data, timeout_s)
        answer.add_done_callback(lambda _: self.wake())
        return answer

    def advertise(self, topic: str, type: str, depth: int) -> str:
        """Create a publisher ahead of its first message; see `GraphConnection.listen`."""
        name = self._services.resolve(topic)
        self._named.add(name)
        self._advertisements[name] = Advertisement(name, type, "reliable", "volatile", depth)
        return self._graph.refusal(name)

    def publish(self, topic: str, values: Mapping[str, Any]) -> None:
        """Publish a message on a topic that is advertised."""
        advertisement = self._advertisements[self._services.resolve(topic)]
        self._graph.publish(advertisement, encode(advertisement.type, values))

    def run(self, fn: Callable[..., T], *args: Any) -> Future[T]:
        """Run slow work in a thread; see `GraphConnection.listen`."""
        job = self._services.workers.submit(fn, *args)
        self._jobs.append(job)
        return job

    def wake(self) -> None:
        """Have `communicate` called again soon."""
        self._services.wake()

    # For the runner

    def subscriptions(self) -> dict[str, Subscription]:
        """Return the subscriptions by topic."""
        return {name: line.subscription for name, line in self._lines.items()}

    def topics(self) -> tuple[str, ...]:
        """Return the names of these topics."""
        return tuple(self._lines)

    def advertisements(self) -> list[Advertisement]:
        """Return its publishers."""
        return list(self._advertisements.values())

    def is_busy(self) -> bool:
        """Return whether the result of slow work was not there for `communicate` yet."""
        return bool(self._jobs)

    def look(self) -> None:
        """Note the work that is done, whose results `communicate` finds next."""
        self._jobs = [job for job in self._jobs if not job.done()]

    def take(self, batches: Mapping[str, Iterable[Raw]], offers: Mapping[str, Offer]) -> None:
        """Keep the messages of this turn; cheap, since they are not read yet."""
        self._offers = offers
        for name, line in self._lines.items():
            if name in batches and line.is_open:
                line.waiting.extend(raw.cdr for raw in batches[name])
                size = sum(map(len, line.waiting))
                if len(line.waiting) > LIMIT or (len(line.waiting) > 1 and size > MAX_BYTES):
                    self._break(line)

    def forget_unnamed(self) -> None:
        """Drop the topics that `communicate` has not named since the last call."""
        named, self._named = self._named, set()
        self._lines = {name: line for name, line in self._lines.items() if name in named}
        self._advertisements = {
            name: each for name, each in self._advertisements.items() if name in named
        }

    def pause(self) -> None:
        """Keep no messages until the display listens again."""
        for line in self._lines.values():
            self._break(line)

    def close(self) -> None:
        """Drop all topics, and work that has not begun."""
        self._lines.clear()
        self._advertisements.clear()
        for job in self._jobs:
            self._services.workers.cancel(job)
        self._jobs.clear()

    def _break(self, line: _Line) -> None:
        line.waiting.clear()
        line.has_gap, line.is_open = True, False
