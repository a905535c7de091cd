"""What a display says about itself: a level and a sentence for each key, as in RViz."""

from __future__ import annotations

import enum
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any


class Level(enum.IntEnum):
    """How well something is; the worst child decides for its parent."""

    OK = 0
    WARN = 1
    ERROR = 2


@dataclass(frozen=True)
class Remedy:
    """A property of the display that would help with another value.

    Args:
        path: dotted, such as `topic.name`.
        value: to give it.
    """

    path: str
    value: Any


@dataclass(frozen=True)
class Status:
    """One line below a display: what is, and what to do about it.

    Args:
        level: how bad it is.
        text: a sentence.
        remedy: what a click could do about it, None if that takes more.
    """

    level: Level
    text: str
    remedy: Remedy | None = None


def worst(statuses: Iterable[Status]) -> Level:
    """The level of a parent with these children."""
    return max((status.level for status in statuses), default=Level.OK)
