"""Titles of what displays show outside of the tree: image panes and legends."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from webviz.api.display import inputs
from webviz.engine.state import Row
from webviz.page.content.forms import sendable


def titles(rows: Iterable[Row]) -> Mapping[str, str]:
    """Return the topic of each display by id, with its name if others of them have the same topic.

    A display without a topic has its name as title.
    """
    topics = {row.id: (_topic(row), row.name) for row in rows}
    count = Counter(topic for topic, _ in topics.values())
    return {id_: str(sendable(_title(*each, count[each[0]]))) for id_, each in topics.items()}


def _topic(row: Row) -> str:
    """Return the first topic of a display, "" if it has none."""
    named = (topic.name for _, _, topic in inputs(row.display)) if row.display else iter(())
    return next(filter(None, named), "")


def _title(topic: str, name: str, sharing: int) -> str:
    if not topic:
        return name
    return topic if sharing == 1 else f"{topic} ({name})"
