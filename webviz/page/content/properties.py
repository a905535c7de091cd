"""Statuses and properties of one display."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import msgspec

from webviz.api.declared import Topic
from webviz.api.display import inputs
from webviz.api.ports import ANY
from webviz.api.status import Status
from webviz.engine.state import Row, State
from webviz.engine.store import PageStore
from webviz.page.content.displays import LevelName, RemedyButton, causes, level_name, remedy_of
from webviz.page.content.forms import Form, brief, form, sendable, values_of
from webviz.page.content.visibility import names, switches_of
from webviz.sources import Offer, Publisher

IN_THE_TREE = ("name", "enabled")
"""Properties that the tree of displays shows."""
MAX_STATUSES = 40


class StatusLine(msgspec.Struct, frozen=True, array_like=True):
    """A status, and the button of a command that would help."""

    key: str
    level: LevelName
    text: str
    remedy: RemedyButton | None


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
    """

    rate: float | None
    qos: str


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


class StatusesStore(PageStore, frozen=True):
    """Statuses of a display or of the viewer.

    Args:
        statuses: of very many the worst.
        more: how many are left out.
    """

    statuses: Sequence[StatusLine]
    more: int


class TopicOffer(msgspec.Struct, frozen=True):
    """A live topic for a property.

    Args:
        publishers: how many there are.
        rate: see `LiveTopic`.
        shown: names of the displays that show it.
        problem: of its QoS, a sentence or "".
    """

    publishers: int
    rate: float | None
    shown: Sequence[str]
    problem: str


class TopicOffersStore(PageStore, frozen=True):
    """Live topics of message types, by name."""

    spread: ClassVar = {"topics": ""}

    topics: Mapping[str, TopicOffer]


def properties(state: State, id_: str) -> PropertiesStore | None:
    """Properties of the display with this id; None if it is gone."""
    row = _row(state, id_)
    if row is None:
        return None
    name = str(sendable(row.name))
    if row.display is None:
        return PropertiesStore(name, row.type, _worst(row))
    offered = {path: sendable(each) for path, each in row.offered.items()}
    switches = {each.path: sendable(names(state.rows, row)) for each in switches_of(row)}
    return PropertiesStore(
        name=name,
        type=row.type,
        worst=_worst(row),
        declared=form(type(row.display), IN_THE_TREE),
        values=values_of(row.display, IN_THE_TREE),
        offered=offered | switches,
        topics={name: _live(topic, state) for name, _, topic in inputs(row.display)},
    )


def statuses(state: State, id_: str) -> StatusesStore | None:
    """Return the statuses of the display with this id; None if it is gone."""
    row = _row(state, id_)
    return lines(row.statuses, row.id, causes(state)) if row else None


def topics_of(state: State, types: str) -> TopicOffersStore:
    """Return the live topics of message types, each with its rate and who has to do with it.

    Args:
        state: of the viewer.
        types: separated by commas, or `ANY`.
    """
    wanted = types.split(",")

    def fits(publisher: Publisher) -> bool:
        return publisher.type in wanted or types == ANY

    shown: dict[str, list[str]] = {}
    for row in state.rows:
        for _, _, topic in inputs(row.display) if row.display else ():
            shown.setdefault(topic.name, []).append(str(sendable(row.name)))
    return TopicOffersStore(
        {
            str(sendable(name)): TopicOffer(
                publishers=sum(map(fits, offer.publishers)),
                rate=_rate(name, state),
                shown=shown.get(name, []),
                problem=str(sendable(offer.problem)),
            )
            for name, offer in state.offers.items()
            if any(map(fits, offer.publishers))
        }
    )


def lines(
    statuses: Mapping[str, Status], display: str = "", known: Sequence[Status] = ()
) -> StatusesStore:
    """Statuses as the page shows them.

    Args:
        statuses: by key.
        display: id of the display they belong to, "" for the viewer.
        known: causes of which they may be a consequence; see `causes`.
    """
    all_ = list(statuses.items())
    if len(all_) > MAX_STATUSES:
        all_ = sorted(all_, key=lambda line: -line[1].level)[:MAX_STATUSES]
    return StatusesStore(
        statuses=[_line(*line, display, known) for line in all_],
        more=len(statuses) - len(all_),
    )


def _line(key: str, status: Status, display: str, known: Sequence[Status]) -> StatusLine:
    remedy = remedy_of(status, display, known)
    return StatusLine(brief(key), level_name(status.level), brief(status.text), remedy)


def _worst(row: Row) -> WorstStatus | None:
    for key, status in row.statuses.items():
        if status.level == row.level:
            text = brief(status.text) if status.level else ""
            return WorstStatus(brief(key), level_name(status.level), text)
    return None


def _row(state: State, id_: str) -> Row | None:
    return next((row for row in state.rows if row.id == id_), None)


def _live(topic: Topic, state: State) -> LiveTopic:
    name = topic.name if topic.name.startswith("/") else f"/{topic.name}"
    offer = state.offers.get(name)
    return LiveTopic(_rate(name, state), _qos(topic, offer))


def _rate(topic: str, state: State) -> float | None:
    """In Hz, as precise as it stays the same for a while; None without a subscription."""
    if (traffic := state.traffic.get(topic)) is None:
        return None
    return round(traffic.rate_hz) if traffic.rate_hz >= 10 else round(traffic.rate_hz, 1)


def _qos(topic: Topic, offer: Offer | None) -> str:
    """In words: what was chosen, and what "auto" became."""
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
