"""Statuses and properties of one display."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from webviz.api.declared import Topic
from webviz.api.display import inputs
from webviz.api.ports import ANY
from webviz.api.status import Status
from webviz.engine.state import Row, State
from webviz.page.content.displays import causes, level_name, remedy_of
from webviz.page.content.forms import brief, form, sendable, values_of
from webviz.page.content.visibility import names, switches_of
from webviz.sources import Offer, Publisher

IN_THE_TREE = ("name", "enabled")
"""Properties that the tree of displays shows."""
MAX_STATUSES = 40


def properties(state: State, id_: str) -> Mapping[str, Any]:
    """Of the display with this id; nothing if it is gone.

    "name" and "type"; "declared", see `form`; each value, see `values_of`; for each input
    "topic." and its path: what is known of the topic; for switches by name "offered." and their
    path: the names, with how many things have each, or with the types of displays; "worst" of the
    statuses.
    """
    row = _row(state, id_)
    if row is None:
        return {}
    told: dict[str, Any] = {"name": sendable(row.name), "type": row.type, "worst": _worst(row)}
    if row.display is None:
        return told
    told["declared"] = form(type(row.display), IN_THE_TREE)
    told |= values_of(row.display, IN_THE_TREE)
    told |= {f"offered.{path}": sendable(each) for path, each in row.offered.items()}
    told |= {f"offered.{each.path}": sendable(names(state.rows, row)) for each in switches_of(row)}
    return told | {f"topic.{name}": _live(topic, state) for name, _, topic in inputs(row.display)}


def statuses(state: State, id_: str) -> Mapping[str, Any]:
    """The "statuses" of the display with this id, see `lines`."""
    row = _row(state, id_)
    return lines(row.statuses, row.id, causes(state)) if row else {}


def topics_of(state: State, types: str) -> Mapping[str, Any]:
    """The live topics of message types by name, each with its rate and who has to do with it.

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
    return {
        str(sendable(name)): {
            "publishers": sum(map(fits, offer.publishers)),
            "rate": _rate(name, state),
            "shown": shown.get(name, []),
            "problem": sendable(offer.problem),
        }
        for name, offer in state.offers.items()
        if any(map(fits, offer.publishers))
    }


def lines(
    statuses: Mapping[str, Status], display: str = "", known: Sequence[Status] = ()
) -> Mapping[str, Any]:
    """Statuses as the page shows them: key, level, text, and what a click could do about it.

    Args:
        statuses: by key.
        display: id of the display they belong to, "" for the viewer.
        known: causes of which they may be a consequence; see `causes`.

    Returns:
        The lines in "statuses", of very many the worst, and in "more" how many are left out.
    """
    all_ = list(statuses.items())
    if len(all_) > MAX_STATUSES:
        all_ = sorted(all_, key=lambda line: -line[1].level)[:MAX_STATUSES]
    return {
        "statuses": [_line(*line, display, known) for line in all_],
        "more": len(statuses) - len(all_),
    }


def _line(key: str, status: Status, display: str, known: Sequence[Status]) -> list[Any]:
    line = [brief(key), level_name(status.level), brief(status.text)]
    told = remedy_of(status, display, known)
    return [*line, told] if told else line


def _worst(row: Row) -> Mapping[str, Any] | None:
    """The first of the worst statuses; its text, if all is well, changes all the time: none."""
    for key, status in row.statuses.items():
        if status.level == row.level:
            text = brief(status.text) if status.level else ""
            return {"key": brief(key), "level": level_name(status.level), "text": text}
    return None


def _row(state: State, id_: str) -> Row | None:
    return next((row for row in state.rows if row.id == id_), None)


def _live(topic: Topic, state: State) -> Mapping[str, Any]:
    name = topic.name if topic.name.startswith("/") else f"/{topic.name}"
    offer = state.offers.get(name)
    return {"rate": _rate(name, state), "qos": _qos(topic, offer)}


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
