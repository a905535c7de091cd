"""The interface of a source of messages."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, runtime_checkable

import msgspec

from webviz.api.bridge import Bridge
from webviz.api.declared import Topic
from webviz.api.lookback import Lookback
from webviz.api.offer import Offer
from webviz.api.robots import NamespacedRobot
from webviz.sources.graph import Graph
from webviz.sources.inbox import Inbox


@dataclass(frozen=True)
class Subscription:
    """A request for a subscription.

    Args:
        type: the message type, such as "nav_msgs/msg/Path".
        topic: full name, and the QoS that the user chose.
        latched: transient local, whatever publishers offer.
        resubscriptions: counter, increased to make publishers repeat latched messages; see
            `Subscriber`.
        lookbacks: which past messages of a recording readers need; `since` is a topic. By default
            the newest one.
        is_placed: whether messages need the transforms at their stamp.
    """

    type: str
    topic: Topic
    latched: bool = False
    resubscriptions: int = 0
    lookbacks: tuple[Lookback, ...] = field(default=(Lookback(count=1),), compare=False)
    is_placed: bool = field(default=False, compare=False)


def merged(subscriptions: Iterable[Mapping[str, Subscription]]) -> dict[str, Subscription]:
    """All subscriptions by topic. The first decides on the type of a topic.

    A topic has one subscription. It follows the publishers if its readers do not agree on the QoS,
    so that none of them misses messages for the choice of another. Best effort meets all
    publishers, so it holds beside readers that chose nothing.
    """
    by_name: dict[str, Subscription] = {}
    for subscription in subscriptions:
        for topic, other in subscription.items():
            first = by_name.setdefault(topic, other)
            if first is not other:
                by_name[topic] = _shared(first, other)
    return by_name


def _shared(first: Subscription, other: Subscription) -> Subscription:
    """Return a subscription that serves both."""
    first = replace(
        first,
        resubscriptions=max(first.resubscriptions, other.resubscriptions),
        lookbacks=(*first.lookbacks, *other.lookbacks),
        is_placed=first.is_placed or other.is_placed,
    )
    if other.type != first.type:
        return first
    topic, latched = first.topic, first.latched
    if other.topic.reliability != topic.reliability:
        chosen = {topic.reliability, other.topic.reliability}
        reliability = "best_effort" if chosen == {"auto", "best_effort"} else "auto"
        topic = msgspec.structs.replace(topic, reliability=reliability)
    if (other.latched, other.topic.durability) != (latched, topic.durability):
        topic, latched = msgspec.structs.replace(topic, durability="auto"), False
    return replace(first, topic=topic, latched=latched)


class Source(Protocol):
    """A live ROS graph, a bridge or a bag."""

    @property
    def inbox(self) -> Inbox:
        """The messages that arrived."""
        ...

    @property
    def graph(self) -> Graph:
        """Graph for output."""
        ...

    @property
    def bridges(self) -> Sequence[Bridge]:
        """The links to bridges that it needs; none of a bag or of the ROS graph itself."""
        ...

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these, by topic name."""
        ...

    def offers(self) -> Mapping[str, Offer]:
        """Return publishers and QoS by topic; another object only after a change."""
        ...

    def now_ns(self) -> int:
        """ROS time; 0 while it is unknown."""
        ...

    def clock_messages(self) -> int | None:
        """Return the number of /clock messages that set ROS time; None while it is wall time."""
        ...

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic, remapped and in the namespace of the source.

        Raises:
            ValueError: it is not a valid topic name; one sentence.
        """
        ...

    def close(self) -> None:
        """Stop all threads."""
        ...


@runtime_checkable
class Fleet(Protocol):
    """A source that connects to robots."""

    def follow(self, robots: Sequence[NamespacedRobot]) -> None:
        """Make the connections exactly those of these robots; existing ones stay open."""
        ...


_COUNT = itertools.count(1)


class Subscriber:
    """One reader of topics, which gets their latched messages even if others read them already.

    A topic has one subscription for all readers, and publishers send latched messages only to new
    subscriptions. So a topic that is new to a reader is subscribed anew.
    """

    def __init__(self) -> None:
        self._counts: dict[tuple[str, str], int] = {}

    def subscribe(self, subscriptions: Mapping[str, Subscription]) -> dict[str, Subscription]:
        """Read exactly these topics, by full name.

        Returns:
            The same subscriptions with `resubscriptions`, higher for topics and types that were not
            in the previous call.
        """
        previous, self._counts = self._counts, {}
        counted_subscriptions = {}
        for name, subscription in subscriptions.items():
            key = name, subscription.type
            self._counts[key] = count = previous.get(key) or next(_COUNT)
            counted_subscriptions[name] = replace(subscription, resubscriptions=count)
        return counted_subscriptions

    def ask(self) -> None:
        """Request all latched messages again."""
        self._counts.clear()
