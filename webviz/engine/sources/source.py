"""The interface of a source of messages."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Protocol

from webviz.api.declared import Topic
from webviz.engine.sources.graph import Durability, Graph, Reliability
from webviz.engine.sources.inbox import Inbox


@dataclass(frozen=True)
class Subscription:
    """A wanted subscription.

    Args:
        type: the message type, such as "nav_msgs/msg/Path".
        topic: full name, and the QoS that the user chose.
        latched: transient local, whatever publishers offer.
        asked: increased to make publishers repeat latched messages; see `Subscriber`.
    """

    type: str
    topic: Topic
    latched: bool = False
    asked: int = 0


def merged(wishes: Iterable[Mapping[str, Subscription]]) -> dict[str, Subscription]:
    """All subscriptions by topic. The first decides on type and QoS of a topic."""
    wanted: dict[str, Subscription] = {}
    for wish in wishes:
        for topic, subscription in wish.items():
            first = wanted.setdefault(topic, subscription)
            if subscription.asked > first.asked:
                wanted[topic] = replace(first, asked=subscription.asked)
    return wanted


@dataclass(frozen=True)
class Publisher:
    """A publisher of a topic.

    Args:
        node: full node name, "" for a DDS program without a ROS node.
        type: message type.
        reliability, durability: offered QoS.
    """

    node: str
    type: str
    reliability: Reliability
    durability: Durability

    @property
    def label(self) -> str:
        """Its node, for sentences."""
        return self.node or "a DDS program"


@dataclass(frozen=True)
class Offer:
    """Publishers and QoS of one topic.

    Args:
        publishers: all of them.
        requested: reliability and durability of our subscription, None without one.
        problem: why no message can arrive, "" if it can.
        type: of our subscription, "" without one; a topic can be read as one type only.
        subscribers: their number, webviz included; None if unknown.
    """

    publishers: tuple[Publisher, ...]
    requested: tuple[Reliability, Durability] | None = None
    problem: str = ""
    type: str = ""
    subscribers: int | None = None


class Source(Protocol):
    """A live ROS graph or a bag."""

    inbox: Inbox

    @property
    def graph(self) -> Graph:
        """For output."""
        ...

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these, by topic name."""
        ...

    def offers(self) -> Mapping[str, Offer]:
        """Publishers and QoS by topic; another object only after a change."""
        ...

    def now_ns(self) -> int:
        """ROS time; 0 while it is unknown."""
        ...

    def clock_messages(self) -> int | None:
        """How many messages of /clock have set ROS time; None while ROS time is wall time."""
        ...

    def resolve(self, topic: str) -> str:
        """The full name of a topic, remapped and in the namespace of the source.

        Raises:
            ValueError: it is not a valid topic name; one sentence.
        """
        ...

    def close(self) -> None:
        """Stop all threads."""
        ...
