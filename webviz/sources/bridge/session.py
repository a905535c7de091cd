"""The interface of one connection to a bridge, in the protocol of its server."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import replace
from typing import Protocol

import msgspec

from webviz.api.bridge import BridgeParameters
from webviz.api.offer import Durability, Endpoint, Offer, Publisher
from webviz.sources.graph import Advertisement, NotConnected
from webviz.sources.source import Subscription


class WireError(ValueError):
    """A frame is not of the protocol; one sentence."""


class CarriedTopic(msgspec.Struct, frozen=True):
    """A topic that the bridge offers.

    Args:
        publishers: of any type.
        problem: why none of its messages can be read, "" if they can.
        readers: the subscriptions, None if they are unknown.
    """

    publishers: tuple[Publisher, ...]
    problem: str = ""
    readers: tuple[Endpoint, ...] | None = None

    def offer(self, subscription: Subscription | None, problem: str) -> Offer:
        """Return the offer of this topic.

        Args:
            subscription: our subscription, None without one.
            problem: why no message can arrive, "" if it can.
        """
        count = None if self.readers is None else len(self.readers)
        offer = Offer(self.publishers, None, problem, "", count, readers=self.readers or ())
        matching = [
            p for p in self.publishers if subscription is not None and p.type == subscription.type
        ]
        if subscription is None or not matching:
            return offer
        is_latched = all(p.durability == "transient_local" for p in matching)
        policies = "reliable", "transient_local" if is_latched else "volatile"
        return replace(offer, requested=policies, type=subscription.type)


class Host(Protocol):
    """The part of the source that a session uses, in the thread of the connection."""

    def send(self, frame: str | bytes) -> None:
        """Send a frame soon, after those before it."""
        ...

    def arrive(self, topic: str, cdr: bytes, stamp_ns: int) -> None:
        """Take a message, with the time at which the bridge received it; 0 if unknown."""
        ...

    def set_time(self, stamp_ns: int) -> None:
        """Take the simulated time."""
        ...

    def learn(self, topic: str, type: str, definition: str) -> str:
        """Read a topic by the definition of its type; why that cannot be, "" if it can."""
        ...

    def learn_service(self, type: str, request: str, response: str) -> None:
        """Register a service type by its definitions, unless it is known."""
        ...

    def look(self) -> None:
        """Read the topics, nodes and remarks again, as they have changed."""
        ...


class BridgeSession(Protocol):
    """One connection; all methods are called in its thread and return at once."""

    protocol: str
    """Its name, for sentences."""

    @property
    def topics(self) -> Mapping[str, CarriedTopic]:
        """All topics, by name."""
        ...

    @property
    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes of the graph, sorted."""
        ...

    @property
    def parameters(self) -> BridgeParameters:
        """The nodes with parameters, as far as the bridge tells them."""
        ...

    @property
    def remarks(self) -> Sequence[str]:
        """Sentences: what is wrong with the connection, and what the bridge says."""
        ...

    @property
    def limits(self) -> Sequence[str]:
        """Sentences: what the bridge does not pass on."""
        ...

    def start(self) -> None:
        """Send what the server has to know first."""
        ...

    def beside(self, host: Host) -> BridgeSession:
        """Return a session for a second connection to the server, for large topics."""
        ...

    def receive(self, frame: str | bytes) -> None:
        """Take a frame.

        Raises:
            WireError: it is not of the protocol.
        """
        ...

    def want(
        self, subscriptions: Mapping[str, Subscription], resting: Collection[str] = frozenset()
    ) -> None:
        """Make the subscriptions exactly these, as far as they are offered.

        Args:
            subscriptions: by topic.
            resting: topics of which no message shall come for now.
        """
        ...

    def advertise(self, advertisements: Collection[Advertisement]) -> None:
        """Make the advertised publishers exactly these.

        Raises:
            NotConnected: the server takes no messages.
        """
        ...

    def publish(self, advertisement: Advertisement, cdr: bytes) -> int:
        """Publish a message; the number of subscriptions, `UNKNOWN` if the bridge does not tell.

        Raises:
            NotConnected: the server takes no messages.
        """
        ...

    def call(self, service: str, type: str, request: bytes, answer: Future[bytes]) -> None:
        """Call a service.

        Raises:
            NotConnected: the server does not offer it.
        """
        ...

    def forget(self, answer: Future[bytes]) -> None:
        """Expect the response of a call no longer."""
        ...

    def fetch(self, uri: str, answer: Future[bytes]) -> None:
        """Fetch a file of the robot, such as package://robot/meshes/arm.stl.

        Raises:
            NotConnected: the server has none.
        """
        ...

    def close(self, problem: str) -> None:
        """Fail everything that is pending."""
        ...


def usual_durability(topic: str, type: str) -> Durability:
    """Return what publishers of such a topic usually offer, as bridges do not tell it."""
    is_latched = (
        topic.endswith(("/tf_static", "/robot_description")) or type == "nav_msgs/msg/OccupancyGrid"
    )
    return "transient_local" if is_latched else "volatile"


def fail(answer: Future[bytes], problem: str | NotConnected) -> None:
    """End a request without an answer."""
    if not answer.done():
        error = NotConnected(problem) if isinstance(problem, str) else problem
        answer.set_exception(error)


def succeed(answer: Future[bytes], data: bytes) -> None:
    """Answer a request."""
    if not answer.done():
        answer.set_result(data)
