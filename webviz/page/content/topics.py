"""Topics: who publishes them and how, what arrives, and the last message of one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from webviz.api.display import Display
from webviz.api.registry import display_types
from webviz.engine.commands.by_topic import Pick, no_display, picks
from webviz.engine.state import State
from webviz.sources import Offer, Publisher


def topics(state: State, _: str) -> Mapping[str, Any]:
    """By name: "types", "nodes" that publish it, "subscribers", "qos", "show" and "why".

    "show" has the displays that fit, each with the properties that show the topic; "why" says why
    there is none.
    """
    return _topics(state.offers, display_types())


def traffic(state: State, _: str) -> Mapping[str, Any]:
    """By name, of topics with a subscription here: "hz", "bytes" per second, "delay" in seconds."""
    return {
        topic: {
            "hz": _digits(traffic.rate_hz, 3),
            "bytes": _digits(traffic.bytes_per_s, 2),
            **({} if traffic.delay_s is None else {"delay": _digits(traffic.delay_s, 2)}),
        }
        for topic, traffic in state.traffic.items()
    }


def message(state: State, topic: str) -> Mapping[str, Any]:
    """The last message on a topic: see `webviz.engine.state.Inspected`."""
    inspected = state.inspected.get(topic)
    if inspected is None:
        return {}
    return {
        "message": inspected.message,
        "problem": inspected.problem,
        "size": inspected.size,
        "received": round(inspected.received_s, 1),
    }


def _topics(
    offers: Mapping[str, Offer], displays: Mapping[str, type[Display]]
) -> Mapping[str, Any]:
    types = {
        name: tuple(sorted({publisher.type for publisher in offer.publishers}))
        for name, offer in offers.items()
    }
    fits: dict[str, list[Pick]] = {}
    for pick in picks(types, displays):
        fits.setdefault(pick.topic, []).append(pick)
    return {name: _topic(offer, types[name], fits.get(name, [])) for name, offer in offers.items()}


def _topic(offer: Offer, types: Sequence[str], fits: Sequence[Pick]) -> Mapping[str, Any]:
    publishers = offer.publishers
    return {
        "types": types,
        "nodes": [publisher.node or "a DDS program" for publisher in publishers],
        "subscribers": offer.subscribers,
        "qos": _qos(publishers),
        "show": [[pick.display, pick.values] for pick in fits],
        "why": "" if fits else no_display(types),
    }


def _qos(publishers: Sequence[Publisher]) -> str:
    """Return the QoS of publishers, "mixed" where they differ."""
    reliabilities = {publisher.reliability for publisher in publishers}
    durabilities = {publisher.durability for publisher in publishers}
    words = [each.pop() if len(each) == 1 else "mixed" for each in (reliabilities, durabilities)]
    return ", ".join(words).replace("_", " ") if publishers else ""


def _digits(value: float, digits: int) -> float:
    """So many digits, for what changes a little all the time."""
    return float(f"{value:.{digits}g}")
