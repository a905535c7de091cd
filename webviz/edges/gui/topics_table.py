"""Topics as an HTML table: who publishes what, how, and how much of it arrives."""

from __future__ import annotations

from collections.abc import Mapping

from webviz.edges.gui.text import escape, note_html
from webviz.engine.sources import Offer, Publisher
from webviz.engine.state import Traffic

MAX_ROWS = 200
UNITS = ("B/s", "kB/s", "MB/s", "GB/s")


def topics_html(
    offers: Mapping[str, Offer], traffic: Mapping[str, Traffic], filter_text: str = ""
) -> str:
    """A line for each topic, sorted; of very many the first.

    Args:
        offers: publishers by topic name.
        traffic: what arrives, of the topics that are subscribed to.
        filter_text: words that the name or a type must have.
    """
    words = filter_text.lower().split()
    found = [name for name in sorted(offers) if _matches(words, name, offers[name])]
    if not found:
        return note_html("No topic with these words." if words else "No topic is published.")
    rows = "".join(_row(name, offers[name], traffic.get(name)) for name in found[:MAX_ROWS])
    more = len(found) - MAX_ROWS
    note = note_html(f"… and {more} more: type a part of the name above.") if more > 0 else ""
    return f'<table class="webviz-table">{rows}</table>{note}'


def qos_of(publishers: tuple[Publisher, ...]) -> str:
    """What publishers offer, "mixed" where they differ."""
    reliabilities = {publisher.reliability for publisher in publishers}
    durabilities = {publisher.durability for publisher in publishers}
    words = [each.pop() if len(each) == 1 else "mixed" for each in (reliabilities, durabilities)]
    return ", ".join(words).replace("_", " ")


def amount(bytes_per_s: float) -> str:
    """Bytes in a second, with a unit that leaves few digits."""
    size, unit = bytes_per_s, 0
    while size >= 1000.0 and unit < len(UNITS) - 1:
        size, unit = size / 1000.0, unit + 1
    return f"{size:.0f} {UNITS[unit]}" if unit == 0 or size >= 100 else f"{size:.1f} {UNITS[unit]}"


def _matches(words: list[str], name: str, offer: Offer) -> bool:
    text = " ".join((name, *(publisher.type for publisher in offer.publishers))).lower()
    return all(word in text for word in words)


def _row(name: str, offer: Offer, traffic: Traffic | None) -> str:
    publishers = offer.publishers
    types = ", ".join(sorted({publisher.type for publisher in publishers}))
    facts = (
        [types, _counted(len(publishers)), qos_of(publishers)] if publishers else ["no publisher"]
    )
    small = escape(" · ".join(facts))
    flow = ""
    if traffic is not None:
        flow = f"{traffic.rate_hz:.1f} Hz<br><small>{amount(traffic.bytes_per_s)}</small>"
    return f"<tr><td>{escape(name)}<br><small>{small}</small></td><td>{flow}</td></tr>"


def _counted(publishers: int) -> str:
    return "1 publisher" if publishers == 1 else f"{publishers} publishers"
