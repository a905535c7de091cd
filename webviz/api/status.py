"""Statuses: a level and a sentence per key, as in RViz."""

from __future__ import annotations

import enum
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import msgspec

from webviz.data.transforms.reasons import Explanation

LOADING = "Loading"
"""Key of the status of a display that will soon draw more: files or threads are at work."""


class Level(enum.IntEnum):
    """The severity of a status; a parent has that of its worst child.

    IDLE, in grey, is neither good nor bad: what is to be drawn loads or waits, or nothing is
    received while no browser shows the pane. It counts more than OK, since nothing is there yet.
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
        label: of the button that does it, in the imperative.
    """

    path: str
    value: Any
    label: str = "Use it"


@dataclass(frozen=True)
class OtherFixedFrame:
    """A fixed frame in which more could be drawn.

    Args:
        frame: its id.
    """

    frame: str

    @staticmethod
    def of(reason: Explanation) -> OtherFixedFrame | None:
        """Return where a frame without a pose has one, None if the reason names no such frame."""
        return OtherFixedFrame(reason.other_frame) if reason.other_frame else None

    @property
    def label(self) -> str:
        """Label of the button that chooses the frame."""
        return f"Use {self.frame}"


class Measurement(msgspec.Struct, frozen=True):
    """A value that a status was made of, as exact as it was measured.

    Args:
        name: such as "age" or "rate".
        value: in `unit`.
        unit: an SI unit, or "" for counts and shares.
    """

    name: str
    value: float
    unit: str = ""


@dataclass(frozen=True)
class Status:
    """A status: its level, and a sentence with the cause and a remedy.

    Args:
        level: its severity.
        text: a sentence.
        remedy: a change that would help, None if none would.
        reason: why a frame has no pose, if that is the cause; for checks, which see more.
        values: measured, for programs. Words for people have few digits, so that they change
            seldom.
    """

    level: Level
    text: str
    remedy: Remedy | OtherFixedFrame | None = None
    reason: Explanation | None = None
    values: tuple[Measurement, ...] = ()


def worst_status(statuses: Iterable[Status]) -> Status:
    """Return the status that a parent with these children has, the first of the worst ones."""
    order = Level.OK, Level.IDLE, Level.WARN, Level.ERROR
    return max(statuses, key=lambda each: order.index(each.level), default=Status(Level.OK, ""))


def worst(statuses: Iterable[Status]) -> Level:
    """Return the level of a parent with these children."""
    return worst_status(statuses).level
