"""Topics: who publishes them and how, and what arrives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import msgspec

from webviz.api.display import Display
from webviz.api.registry import display_types
from webviz.engine.commands.by_topic import Pick, no_display, picks
from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.sources import Offer, Publisher


class GraphTopic(msgspec.Struct, frozen=True):
    """A topic with publishers.

    Args:
        types: of its messages.
        nodes: that publish it.
        subscribers: how many there are, None if that is unknown.
        qos: of the publishers, "mixed" where they differ.
        show: the displays that fit, each with the properties that show the topic.
        why: there is none, a sentence; "" if there is one.
    """

    types: Sequence[str]
    nodes: Sequence[str]
    subscribers: int | None
    qos: str
    show: Sequence[tuple[str, Mapping[str, Any]]]
    why: str


class TopicsStore(PageStore, frozen=True):
    """The topics by name."""

    spread: ClassVar = {"topics": ""}

    topics: Mapping[str, GraphTopic]


class TopicTraffic(msgspec.Struct, frozen=True):
    """Traffic of a topic with a subscription here.

    Args:
        hz: messages per second.
        bytes: per second.
        delay: in seconds; unset without stamps.
    """

    hz: float
    bytes: float
    delay: float | msgspec.UnsetType = msgspec.UNSET


class TrafficStore(PageStore, frozen=True):
    """Traffic by topic name."""

    spread: ClassVar = {"topics": ""}

    topics: Mapping[str, TopicTraffic]


def topics(state: State, _: str) -> TopicsStore:
    """Return the topics of the graph."""
    return TopicsStore(_topics(state.offers, display_types()))


def traffic(state: State, _: str) -> TrafficStore:
    """Traffic of the topics with a subscription here."""
    return TrafficStore(
        {
            topic: TopicTraffic(
                hz=_digits(traffic.rate_hz, 3),
                bytes=_digits(traffic.bytes_per_s, 2),
                delay=msgspec.UNSET if traffic.delay_s is None else _digits(traffic.delay_s, 2),
            )
            for topic, traffic in state.traffic.items()
        }
    )


def _topics(
    offers: Mapping[str, Offer], displays: Mapping[str, type[Display]]
) -> Mapping[str, GraphTopic]:
    types = {
        name: tuple(sorted({publisher.type for publisher in offer.publishers}))
        for name, offer in offers.items()
    }
    fits: dict[str, list[Pick]] = {}
    for pick in picks(types, displays):
        fits.setdefault(pick.topic, []).append(pick)
    return {name: _topic(offer, types[name], fits.get(name, [])) for name, offer in offers.items()}


def _topic(offer: Offer, types: Sequence[str], fits: Sequence[Pick]) -> GraphTopic:
    publishers = offer.publishers
    return GraphTopic(
        types=types,
        nodes=[publisher.label for publisher in publishers],
        subscribers=offer.subscribers,
        qos=_qos(publishers),
        show=[(pick.display, pick.values) for pick in fits],
        why="" if fits else no_display(types),
    )


def _qos(publishers: Sequence[Publisher]) -> str:
    """Return the QoS of publishers, "mixed" where they differ, "unknown" behind a bridge."""
    if not all(publisher.is_qos_known for publisher in publishers):
        return "unknown"
    reliabilities = {publisher.reliability for publisher in publishers}
    durabilities = {publisher.durability for publisher in publishers}
    words = [each.pop() if len(each) == 1 else "mixed" for each in (reliabilities, durabilities)]
    return ", ".join(words).replace("_", " ") if publishers else ""


def _digits(value: float, digits: int) -> float:
    """So many digits, for what changes a little all the time."""
    return float(f"{value:.{digits}g}")
