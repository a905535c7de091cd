"""What could be added: types of displays, and live topics with the displays that fit."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

from webviz.api.display import Display, inputs, inputs_of
from webviz.api.registry import display_types
from webviz.engine.by_topic import no_display, picks
from webviz.engine.state import State


def types(state: State, _: str) -> Mapping[str, Any]:
    """Every display type by its name: a line of help, and the message types that it shows."""
    return {name: _about(cls) for name, cls in sorted(display_types().items())}


@functools.cache
def _about(cls: type[Display]) -> Mapping[str, Any]:
    text = (cls.__doc__ or "").strip()
    shown = [spec.type for spec in inputs_of(cls).values() if not spec.suffix]
    return {"help": " ".join(text.split("\n\n")[0].split()), "topics": list(dict.fromkeys(shown))}


def addable(state: State, _: str) -> Mapping[str, Any]:
    """Every live topic by its name: its types, displays with the property that takes it, rate in Hz
    or null, number of publishers, whether a display shows it, and why no display fits."""
    shown = {
        f"/{topic.name.removeprefix('/')}"
        for row in state.rows
        for _, _, topic in (inputs(row.display) if row.display else ())
    }
    fitting: dict[str, list[tuple[str, str]]] = {}
    for pick in picks(state.topics, display_types()):
        fitting.setdefault(pick.topic, []).append((pick.display, pick.input))
    return {
        topic: {
            "types": messages,
            "displays": fitting.get(topic, ()),
            "why": "" if topic in fitting else no_display(messages),
            "rate": _rate(state, topic),
            "shown": topic in shown,
            "publishers": len(offer.publishers) if (offer := state.offers.get(topic)) else 0,
        }
        for topic, messages in state.topics.items()
    }


def _rate(state: State, topic: str) -> float | None:
    """Two digits of it, so that it stands still while it is even."""
    traffic = state.traffic.get(topic)
    return None if traffic is None else float(f"{traffic.rate_hz:.2g}")
