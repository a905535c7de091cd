"""Subscriptions of one session."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from webviz.api.offer import Durability
from webviz.sources.source import Subscription
from webviz.sources.zenoh.discovered import GraphSnapshot
from webviz.sources.zenoh.endpoints import DeclaredEndpoint, OwnNode
from webviz.sources.zenoh.engine import directly, engine
from webviz.sources.zenoh.qos import DEFAULT_DEPTH, write_qos
from webviz.sources.zenoh.tokens import NO_HASH, GraphEntity, data_key

Arrive = Callable[[str, Any, bool], None]
"""Takes a topic, a sample, and whether it may be an old one; called in threads of the engine."""


class TopicSubscription(NamedTuple):
    """A subscription, with what it depends on.

    Attributes:
        keys: that are subscribed to.
        resubscriptions: see `Subscription`.
        durability: with which it is subscribed.
        subscribers: of the engine.
        token: in the graph; None behind zenoh-bridge-ros2dds.
    """

    keys: tuple[str, ...]
    resubscriptions: int
    durability: Durability
    subscribers: tuple[Any, ...]
    token: DeclaredEndpoint | None


class ZenohSubscriptions:
    """Subscribes to topics that have publishers.

    Args:
        session: that is open.
        node: of this viewer.
        domain: number of the ROS domain.
        arrive: takes samples.
    """

    def __init__(self, session: Any, node: OwnNode, domain: int, arrive: Arrive) -> None:
        self._session = session
        self._node = node
        self._domain = domain
        self._arrive = arrive
        self._topics: dict[str, TopicSubscription] = {}

    def want(self, subscriptions: Mapping[str, Subscription], graph: GraphSnapshot) -> None:
        """Make the subscriptions exactly these, as far as their topics are published."""
        for topic in [t for t in self._topics if t not in subscriptions]:
            self._end(topic)
        for topic, subscription in subscriptions.items():
            of_type = [p for p in graph.publishers.get(topic, ()) if p.type == subscription.type]
            former = self._topics.get(topic)
            if not of_type and former is not None:
                continue  # as in ROS, a subscription outlives its publishers
            if not of_type:
                continue
            durability = requested_durability(subscription, of_type)
            keys = self._keys(topic, subscription.type, of_type)
            if former is None or former[:3] != (keys, subscription.resubscriptions, durability):
                self._end(topic)
                self._topics[topic] = self._subscribe(
                    topic, subscription, keys, durability, of_type
                )

    def _keys(self, topic: str, type: str, publishers: Sequence[GraphEntity]) -> tuple[str, ...]:
        """Return the keys of the messages of a type: of any version, and those of bridges."""
        keys = {p.key for p in publishers if p.is_bridged}
        if any(not p.is_bridged for p in publishers):
            keys.add(data_key(self._domain, topic, type, "*"))
        return tuple(sorted(keys))

    def _subscribe(
        self,
        topic: str,
        subscription: Subscription,
        keys: tuple[str, ...],
        durability: Durability,
        publishers: Sequence[GraphEntity],
    ) -> TopicSubscription:
        is_latched = durability == "transient_local"

        def take(sample: Any) -> None:
            self._arrive(topic, sample, is_latched)

        subscribers = tuple(self._declared(key, take, is_latched) for key in keys)
        native = next((p for p in publishers if not p.is_bridged), None)
        token = None
        if native is not None:
            reliability = requested_reliability(subscription)
            qos = write_qos(reliability, durability, DEFAULT_DEPTH)
            own = GraphEntity(
                "subscription", "", topic, subscription.type, hash=native.hash or NO_HASH
            )
            token = self._node.declare(own, qos)
        return TopicSubscription(keys, subscription.resubscriptions, durability, subscribers, token)

    def _declared(self, key: str, take: Callable[[Any], None], is_latched: bool) -> Any:
        if not is_latched:
            return self._session.declare_subscriber(key, directly(take))
        history = engine().ext.HistoryConfig(detect_late_publishers=True)
        return engine().ext.declare_advanced_subscriber(
            self._session, key, directly(take), history=history
        )

    def _end(self, topic: str) -> None:
        ended = self._topics.pop(topic, None)
        if ended is None:
            return
        with contextlib.suppress(engine().ZError):  # the session is closing
            for subscriber in ended.subscribers:
                subscriber.undeclare()
            if ended.token is not None:
                ended.token.undeclare()


def requested_reliability(subscription: Subscription) -> Any:
    """Return the reliability of a subscription; over Zenoh all are compatible."""
    return "best_effort" if subscription.topic.reliability == "best_effort" else "reliable"


def requested_durability(
    subscription: Subscription, publishers: Sequence[GraphEntity]
) -> Durability:
    """Return whether the last messages of before are asked for."""
    if subscription.latched or subscription.topic.durability == "transient_local":
        return "transient_local"
    has_cache = any(each.qos.durability == "transient_local" for each in publishers)
    is_refused = subscription.topic.durability == "volatile"
    return "transient_local" if has_cache and not is_refused else "volatile"
