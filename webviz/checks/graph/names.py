"""Similarity of topic names."""

from __future__ import annotations

import difflib

from webviz.api.observation import DisplaySeen, InputSeen
from webviz.api.status import Remedy

SIMILAR = 0.8
"""Ratio of difflib from which a name is a misspelling of another."""


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
