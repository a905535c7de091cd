"""What a display says about itself: a level and a sentence for each key, as in RViz."""

from __future__ import annotations

import enum
from collections.abc import Iterable
from dataclasses import dataclass


class Level(enum.IntEnum):
    """How well something is; the worst child decides for its parent."""

    OK = 0
    WARN = 1
    ERROR = 2


@dataclass(frozen=True)
class Status:
    """One line below a display: what is, and what to do about it."""

    level: Level
    text: str


def worst(statuses: Iterable[Status]) -> Level:
    """The level of a parent with these children."""
    return max((status.level for status in statuses), default=Level.OK)
