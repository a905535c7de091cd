"""Similarity of topic names, and names of nodes for sentences."""

from __future__ import annotations

import difflib
from collections.abc import Sequence

from webviz.api.observation import DisplaySeen, InputSeen
from webviz.api.offer import Endpoint
from webviz.api.status import Remedy

SIMILAR = 0.8
"""Ratio of difflib from which a name is a misspelling of another."""
MAX_NAMED = 5
"""Nodes that are named."""


def suggested(display: DisplaySeen, port: InputSeen) -> Remedy | None:
    """Return the change to a similarly named, published topic of the same type, if any."""
    status = display.problem(port.status)
    remedy = status.remedy if status else None
    if not isinstance(remedy, Remedy) or not isinstance(remedy.value, str):
        return None
    is_near = is_elsewhere(port.topic, remedy.value) or is_similar(port.topic, remedy.value)
    return remedy if is_near else None


def is_elsewhere(topic: str, other: str) -> bool:
    """Return whether two topics differ only in their namespaces."""
    return topic != other and topic.rpartition("/")[2] == other.rpartition("/")[2]


def is_similar(topic: str, other: str) -> bool:
    """Return whether one of the names is probably a misspelling of the other."""
    return difflib.SequenceMatcher(None, topic, other).ratio() >= SIMILAR


def named(ends: Sequence[Endpoint]) -> str:
    """Return the nodes of endpoints, at least one, for sentences."""
    names = [*dict.fromkeys(each.label for each in ends)]
    more = [f"{len(names) - MAX_NAMED} more"] if len(names) > MAX_NAMED else []
    *first, last = [*names[:MAX_NAMED], *more]
    return f"{', '.join(first)} and {last}" if first else last
