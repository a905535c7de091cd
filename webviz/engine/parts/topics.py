"""Topics: who publishes them and how, and what arrives."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import msgspec

from webviz.api.display import Display
from webviz.api.registry import display_types
from webviz.data.messages import MessageError, peek_header
from webviz.engine.parts.by_topic import Pick, no_display, picks
from webviz.engine.parts.declaring import store
from webviz.engine.parts.part import Batches, Part, PartContext
from webviz.engine.state import Traffic
from webviz.engine.store import PageStore
from webviz.sources import Offer, Publisher, Raw

SPAN_S = 3.0
"""Time in seconds over which a rate is measured."""
MEASURED_S = 0.5
EVERY_S = 1.0
"""Interval between measurements of a delay."""
OF_EVERY_NODE = frozenset({"/rosout", "/parameter_events"})
OWN_NODE = "/webviz"
"""Unless it is remapped, which is rare before anything is published."""
SIMULATOR = "/sim"
"""The node of `webviz-sim`."""


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


class GraphStore(PageStore, frozen=True):
    """The ROS graph.

    Args:
        is_empty: whether nothing is published, except by webviz and on topics of every node.
        has_simulator: whether the simulated robot of the demo is there.
    """

    is_empty: bool
    has_simulator: bool


class TopicsPart(Part):
    """Topics, their publishers, and how fast messages arrive."""

    name = "Topics"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._offers: Mapping[str, Offer] | None = None
        self._types: Mapping[str, tuple[str, ...]] = {}
        self._counts: deque[tuple[float, dict[str, tuple[int, int]]]] = deque()
        self.traffic: Mapping[str, Traffic] = {}
        """Traffic of the topics with a subscription here, over the last seconds."""
        self._delays: dict[str, tuple[float, float | None]] = {}

    def take(self, batches: Batches) -> None:
        """Measure delays."""
        for topic, batch in batches.items():
            if (newest := next(reversed(list(batch)), None)) is not None:
                self._measure(topic, newest)

    def reset(self) -> None:
        """Forget delays, which another time makes meaningless."""
        self._delays.clear()

    def state(self) -> Mapping[str, Any]:
        """Return topics, services, and the traffic of what is subscribed to."""
        return {
            "topics": self.types,
            "offers": self.context.offers,
            "services": self.context.graph.services(),
            "traffic": self.traffic,
        }

    def update(self) -> None:
        """Measure the rates anew now and then."""
        now, counts = self.context.clock(), self.context.player.inbox.received()
        if self._counts and 0.0 <= now - self._counts[-1][0] < MEASURED_S:
            self.traffic = {topic: each for topic, each in self.traffic.items() if topic in counts}
        else:
            self.traffic = self._rates(now, counts)

    @property
    def types(self) -> Mapping[str, tuple[str, ...]]:
        """The message types by topic."""
        if self.context.offers is not self._offers:
            self._offers = self.context.offers
            self._types = _types_of(self._offers)
        return self._types

    @store(name="topics", of=lambda part: part.context.offers)
    def topics_of_graph(self, argument: str) -> TopicsStore:
        """Return the topics of the graph."""
        return TopicsStore(_topics(self.context.offers, display_types()))

    @store(of=lambda part: part.context.offers)
    def graph(self, argument: str) -> GraphStore:
        """Return the ROS graph."""
        offers = self.context.offers.items()
        published = (offer for topic, offer in offers if topic not in OF_EVERY_NODE)
        nodes = {publisher.node for offer in published for publisher in offer.publishers}
        return GraphStore(is_empty=not nodes - {OWN_NODE}, has_simulator=SIMULATOR in nodes)

    @store(name="traffic", of=lambda part: part.traffic)
    def traffic_of_all(self, argument: str) -> TrafficStore:
        """Return the traffic of the topics with a subscription here."""
        return TrafficStore(
            {
                topic: TopicTraffic(
                    hz=_digits(traffic.rate_hz, 3),
                    bytes=_digits(traffic.bytes_per_s, 2),
                    delay=msgspec.UNSET if traffic.delay_s is None else _digits(traffic.delay_s, 2),
                )
                for topic, traffic in self.traffic.items()
            }
        )

    def _measure(self, topic: str, raw: Raw) -> None:
        """Note how old a message was when it came, now and then."""
        now = self.context.clock()
        if now - self._delays.get(topic, (-EVERY_S, None))[0] < EVERY_S:
            return
        offer = self.context.offers.get(topic)
        try:
            type_ = type_of(offer) if offer else ""
            header = peek_header(type_, raw.cdr, raw.types) if type_ else None
        except MessageError:
            header = None
        delay = (raw.received_ns - header[1]) / 1e9 if header and header[1] else None
        self._delays[topic] = now, delay

    def _rates(self, now: float, counts: dict[str, tuple[int, int]]) -> dict[str, Traffic]:
        self._counts.append((now, counts))
        while len(self._counts) > 2 and now - self._counts[1][0] >= SPAN_S:
            self._counts.popleft()
        for obsolete in self._delays.keys() - counts.keys():
            del self._delays[obsolete]
        then, before = self._counts[0]
        if now == then:
            return {}
        traffic = {}
        for topic, (count, size) in counts.items():
            old_count, old_size = before.get(topic, (0, 0))
            if count < old_count:  # subscribed anew
                old_count = old_size = 0
            rates = (count - old_count) / (now - then), (size - old_size) / (now - then)
            traffic[topic] = Traffic(*rates, self._delays.get(topic, (0.0, None))[1])
        return traffic


def type_of(offer: Offer) -> str:
    """Return the type its messages are decoded as."""
    return offer.type or (offer.publishers[0].type if offer.publishers else "")


def _topics(
    offers: Mapping[str, Offer], displays: Mapping[str, type[Display]]
) -> Mapping[str, GraphTopic]:
    types = _types_of(offers)
    fits: dict[str, list[Pick]] = {}
    for pick in picks(types, displays):
        fits.setdefault(pick.topic, []).append(pick)
    return {name: _topic(offer, types[name], fits.get(name, [])) for name, offer in offers.items()}


def _types_of(offers: Mapping[str, Offer]) -> Mapping[str, tuple[str, ...]]:
    return {
        name: tuple(sorted({publisher.type for publisher in offer.publishers}))
        for name, offer in offers.items()
    }


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
