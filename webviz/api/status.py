"""Statuses: a level and a sentence per key, as in RViz."""

from __future__ import annotations

import enum
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any


class Level(enum.IntEnum):
    """The severity of a status; a parent has that of its worst child.

    IDLE, in grey, is neither good nor bad: nothing is received while no browser shows the pane.
    """

    IDLE = -1
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
    """A status: its level, and a sentence with the cause and a remedy.

    Args:
        level: its severity.
        text: a sentence.
        remedy: a change of a property that would help, None if none would.
    """

    level: Level
    text: str
    remedy: Remedy | None = None


def worst(statuses: Iterable[Status]) -> Level:
    """The level of a parent with these children."""
    return max((status.level for status in statuses), default=Level.OK)
