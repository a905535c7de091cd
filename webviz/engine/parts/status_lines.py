"""Statuses as pages show them, and the buttons that help."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import msgspec

from webviz.api.status import Level, OtherFixedFrame, Status
from webviz.data.transforms.reasons import FOR_ALL
from webviz.engine.forms import brief, sendable
from webviz.engine.store import PageStore

MAX_STATUSES = 40
LevelName = Literal["idle", "ok", "warn", "error"]

_LEVELS: Mapping[Level, LevelName] = {
    Level.IDLE: "idle",
    Level.OK: "ok",
    Level.WARN: "warn",
    Level.ERROR: "error",
}


class RemedyButton(msgspec.Struct, frozen=True):
    """A button that solves a problem.

    Args:
        label: of the button.
        command: sent by it.
        arguments: those of each time that it is sent; all are undone together.
    """

    label: str
    command: str
    arguments: Sequence[Mapping[str, Any]]


class StatusLine(msgspec.Struct, frozen=True, array_like=True):
    """A status, and the button of a command that would help."""

    key: str
    level: LevelName
    text: str
    remedy: RemedyButton | None


class StatusesStore(PageStore, frozen=True):
    """Statuses of a display or of the viewer.

    Args:
        statuses: of very many the worst.
        more: how many are left out.
    """

    statuses: Sequence[StatusLine]
    more: int


def causes(statuses: Mapping[str, Status]) -> tuple[Status, ...]:
    """Return the problems of the viewer that a click can solve; displays have others by them."""
    return tuple(status for status in statuses.values() if status.remedy)


def remedy_of(status: Status, display: str, statuses: Sequence[Status] = ()) -> RemedyButton | None:
    """Return the button of a command that would help; None if none would.

    Args:
        status: of a display, or of the viewer.
        display: id of the display.
        statuses: see `causes`.
    """
    cause = next((each for each in statuses if follows(status, each)), None)
    remedy = status.remedy or (cause.remedy if cause else None)
    if remedy is None:
        return None
    if isinstance(remedy, OtherFixedFrame):
        command, fields = "SetFixedFrame", {"frame": remedy.frame}
    else:
        command = "SetProperty"
        fields = {"display": display, "path": remedy.path, "value": remedy.value}
    return button(remedy.label, command, fields)


def button(label: str, command: str, *arguments: Mapping[str, Any]) -> RemedyButton:
    """Return a button as pages get it, of a command that it sends with each of these arguments."""
    return RemedyButton(str(sendable(label)), command, [sendable(each) for each in arguments])


def follows(status: Status, cause: Status) -> bool:
    """Return whether a problem of the viewer, such as its fixed frame, is the reason for this."""
    same = status.reason and cause.reason and status.reason.kind is cause.reason.kind
    return bool(same and cause.reason and cause.reason.kind in FOR_ALL)


def lines(
    statuses: Mapping[str, Status], display: str = "", causes: Sequence[Status] = ()
) -> StatusesStore:
    """Statuses as the page shows them.

    Args:
        statuses: by key.
        display: id of the display they belong to, "" for the viewer.
        causes: statuses of which they may be a consequence; see `causes`.
    """
    all_ = list(statuses.items())
    if len(all_) > MAX_STATUSES:
        all_ = sorted(all_, key=lambda line: -line[1].level)[:MAX_STATUSES]
    return StatusesStore(
        statuses=[_line(*line, display, causes) for line in all_],
        more=len(statuses) - len(all_),
    )


def _line(key: str, status: Status, display: str, statuses: Sequence[Status]) -> StatusLine:
    remedy = remedy_of(status, display, statuses)
    return StatusLine(brief(key), level_name(status.level), brief(status.text), remedy)


def level_name(level: Level) -> LevelName:
    """Return a level as the page calls it."""
    return _LEVELS[level]
