"""Properties of one display, and the topics that fit them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import msgspec

from webviz.api.declared import Topic
from webviz.api.display import inputs
from webviz.api.ports import ANY
from webviz.engine.forms import Form, brief, form, sendable, values_of
from webviz.engine.parts.display_rows import topics_of_row
from webviz.engine.parts.status_lines import LevelName, level_name
from webviz.engine.parts.visibility import names, switches_of
from webviz.engine.state import Row, Traffic
from webviz.engine.store import PageStore
from webviz.sources import Offer, Publisher

IN_THE_TREE = ("name", "enabled")
"""Properties that the tree of displays shows."""


class WorstStatus(msgspec.Struct, frozen=True):
    """The first of the worst statuses; of one that is OK, the text would change all the time."""

    key: str
    level: LevelName
    text: str


class LiveTopic(msgspec.Struct, frozen=True):
    """The topic of an input.

    Args:
        rate: in Hz, as precise as it stays the same for a while; None without a subscription.
        qos: in words.
        is_latched: see `Offer`.
    """

    rate: float | None
    qos: str
    is_latched: bool = False


class PropertiesStore(PageStore, frozen=True):
    """The properties of a display.

    Args:
        name, type: of the display.
        worst: of its statuses, None without one.
        declared: unset if it cannot be shown.
        values: see `values_of`.
        offered: for switches by name, the names with how many things have each, or with the types
            of displays; by path.
        topics: of its inputs, by path.
    """

    spread: ClassVar = {"values": "value.", "offered": "offered.", "topics": "topic."}

    name: str
    type: str
    worst: WorstStatus | None
    declared: Form | msgspec.UnsetType = msgspec.UNSET
    values: Mapping[str, Any] = {}
    offered: Mapping[str, Mapping[str, int | str]] = {}
    topics: Mapping[str, LiveTopic] = {}


class RateStore(PageStore, frozen=True):
    """Messages of a display.

    Args:
        hz: how many arrive, to two digits; unset if it does not subscribe.
        is_latched: see `Offer`; unset if it is not.
    """

    hz: float | msgspec.UnsetType = msgspec.UNSET
    is_latched: bool | msgspec.UnsetType = msgspec.UNSET


class TopicOffer(msgspec.Struct, frozen=True):
    """A live topic for a property.

    Args:
        publishers: how many there are.
        rate: see `LiveTopic`.
        displays: names of the displays that show it.
        problem: of its QoS, a sentence or "".
        is_latched: see `Offer`.
    """

    publishers: int
    rate: float | None
    displays: Sequence[str]
    problem: str
    is_latched: bool


class TopicOffersStore(PageStore, frozen=True):
    """Live topics of message types, by name."""

    spread: ClassVar = {"topics": ""}

    topics: Mapping[str, TopicOffer]


def properties(
    row: Row, rows: tuple[Row, ...], offers: Mapping[str, Offer], traffic: Mapping[str, Traffic]
) -> PropertiesStore:
    """Return the properties of a display.

    Args:
        row: of the display.
        rows: of all.
        offers, traffic: by topic.
    """
    name = str(sendable(row.name))
    if row.display is None:
        return PropertiesStore(name, row.type, _worst(row))
    offered = {path: sendable(each) for path, each in row.offered.items()}
    switches = {each.path: sendable(names(rows, row)) for each in switches_of(row)}

    def live(topic: Topic) -> LiveTopic:
        name = topic.name if topic.name.startswith("/") else f"/{topic.name}"
        offer = offers.get(name)
        is_latched = offer is not None and offer.is_latched
        return LiveTopic(_rate(name, traffic), _qos(topic, offer), is_latched)

    return PropertiesStore(
        name=name,
        type=row.type,
        worst=_worst(row),
        declared=form(type(row.display), IN_THE_TREE),
        values=values_of(row.display, IN_THE_TREE),
        offered=offered | switches,
        topics={name: live(topic) for name, _, topic in inputs(row.display)},
    )


def topic_offers(
    types: str,
    rows: tuple[Row, ...],
    offers: Mapping[str, Offer],
    traffic: Mapping[str, Traffic],
) -> TopicOffersStore:
    """Return the live topics of message types, each with its rate and who has to do with it.

    Args:
        types: separated by commas, or `ANY`.
        rows: of all displays.
        offers, traffic: by topic.
    """
    accepted = types.split(",")

    def fits(publisher: Publisher) -> bool:
        return publisher.type in accepted or types == ANY

    displays: dict[str, list[str]] = {}
    for row in rows:
        for _, _, topic in inputs(row.display) if row.display else ():
            displays.setdefault(topic.name, []).append(str(sendable(row.name)))
    return TopicOffersStore(
        {
            str(sendable(name)): TopicOffer(
                publishers=sum(map(fits, offer.publishers)),
                rate=_rate(name, traffic),
                displays=displays.get(name, []),
                problem=str(sendable(offer.problem)),
                is_latched=offer.is_latched,
            )
            for name, offer in offers.items()
            if any(map(fits, offer.publishers))
        }
    )


def rate(row: Row | None, offers: Mapping[str, Offer], traffic: Mapping[str, Traffic]) -> RateStore:
    """Return the rate of messages of a display."""
    topic = next((name for name in topics_of_row(row) if name in traffic), None)
    if topic is None:
        return RateStore()
    offer = offers.get(topic)
    is_latched = offer is not None and offer.is_latched
    return RateStore(_rounded(traffic[topic].rate_hz), is_latched or msgspec.UNSET)


def _worst(row: Row) -> WorstStatus | None:
    for key, status in row.statuses.items():
        if status.level == row.level:
            text = brief(status.text) if status.level else ""
            return WorstStatus(brief(key), level_name(status.level), text)
    return None


def _rate(topic: str, traffic: Mapping[str, Traffic]) -> float | None:
    """Return the rate in Hz, rounded so that it seldom changes; None without a subscription."""
    if (rates := traffic.get(topic)) is None:
        return None
    return round(rates.rate_hz) if rates.rate_hz >= 10 else round(rates.rate_hz, 1)


def _qos(topic: Topic, offer: Offer | None) -> str:
    """Return the chosen QoS in words, and what "auto" became."""
    requested = offer.requested if offer else None
    became = []
    chosen = []
    for index, choice in enumerate((topic.reliability, topic.durability)):
        if choice != "auto":
            chosen.append(choice.replace("_", " "))
        elif requested and (index == 0 or requested[index] == "transient_local"):
            became.append(requested[index].replace("_", " "))
    if topic.depth:
        chosen.append(f"depth {topic.depth}")
    if topic.filter_size != Topic().filter_size:
        chosen.append(f"filter {topic.filter_size}")
    auto = f"auto ({', '.join(became)})" if became else "auto"
    return ", ".join([*chosen, auto] if became or not chosen else chosen)


def _rounded(value: float) -> float:
    if not value > 0.0:
        return 0.0
    return float(round(value, 1 - math.floor(math.log10(value))))
