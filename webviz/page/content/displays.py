"""The tree of displays."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, ClassVar, Literal

import msgspec

from webviz.api.display import Display, inputs
from webviz.api.status import Level, OtherFixedFrame, Status
from webviz.data.transforms.reasons import FOR_ALL
from webviz.engine.state import Row, State
from webviz.engine.store import PageStore
from webviz.page.content.forms import sendable

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
        command, arguments: sent by it.
    """

    label: str
    command: str
    arguments: Mapping[str, Any]


class DisplayRow(msgspec.Struct, frozen=True):
    """A row of the tree.

    Args:
        type, name, depth, enabled: see `webviz.engine.state.Row`.
        icon: see `webviz.Display.icon`.
        can_edit: whether it has properties.
        level: the worst of its statuses.
        line: the first status of this level if it is a problem, "" if not.
        status: its name.
        topics: that it subscribes to.
        remedy: of the problem, if a click can solve it.
    """

    type: str
    icon: str
    name: str
    depth: int
    enabled: bool
    can_edit: bool
    level: LevelName
    line: str
    status: str
    topics: Sequence[str]
    remedy: RemedyButton | msgspec.UnsetType = msgspec.UNSET


class DisplaysStore(PageStore, frozen=True):
    """The tree of displays.

    Args:
        order: the ids from top to bottom.
        rows: by id.
    """

    spread: ClassVar = {"rows": ""}

    order: Sequence[str]
    rows: Mapping[str, DisplayRow]


class RateStore(PageStore, frozen=True):
    """Messages of a display.

    Args:
        hz: how many arrive, to two digits; unset if it does not subscribe.
    """

    hz: float | msgspec.UnsetType = msgspec.UNSET


def displays(state: State, _: str) -> DisplaysStore:
    """Return the tree of displays."""
    return DisplaysStore([row.id for row in state.rows], _rows(state.rows, causes(state)))


def rate(state: State, id_: str) -> RateStore:
    """Rate of messages of the display with this id."""
    row = next((row for row in state.rows if row.id == id_), None)
    known = [state.traffic[name].rate_hz for name in _topics(row) if name in state.traffic]
    return RateStore(_rounded(known[0])) if known else RateStore()


class _Rows:
    """Rows as the page shows them, by id; the same object for a row as long as it is unchanged."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[Row, DisplayRow]] = {}
        self._causes: tuple[Status, ...] = ()

    def __call__(self, rows: Iterable[Row], causes: tuple[Status, ...]) -> Mapping[str, DisplayRow]:
        before = self._known if causes == self._causes else {}
        self._causes = causes
        self._known = now = {
            row.id: known
            if (known := before.get(row.id)) and known[0] is row
            else (row, _row(row, causes))
            for row in rows
        }
        return {id_: shown for id_, (_, shown) in now.items()}


_rows = _Rows()


def causes(state: State) -> tuple[Status, ...]:
    """Return the problems of the viewer that a click can solve.

    Displays have others because of them.
    """
    return tuple(status for status in state.statuses.values() if status.remedy)


def remedy_of(status: Status, display: str, known: Sequence[Status] = ()) -> RemedyButton | None:
    """Return the button of a command that would help; None if none would.

    Args:
        status: of a display, or of the viewer.
        display: id of the display.
        known: see `causes`.
    """
    cause = next((each for each in known if _follows(status, each)), None)
    remedy = status.remedy or (cause.remedy if cause else None)
    if remedy is None:
        return None
    if isinstance(remedy, OtherFixedFrame):
        command, fields = "SetFixedFrame", {"frame": remedy.frame}
    else:
        command = "SetProperty"
        fields = {"display": display, "path": remedy.path, "value": remedy.value}
    return RemedyButton(str(sendable(remedy.label)), command, sendable(fields))


def _follows(status: Status, cause: Status) -> bool:
    """Return whether a problem of the viewer, such as its fixed frame, is the reason for this."""
    same = status.reason and cause.reason and status.reason.kind is cause.reason.kind
    return bool(same and cause.reason and cause.reason.kind in FOR_ALL)


def _row(row: Row, causes: Sequence[Status]) -> DisplayRow:
    level = row.level
    name, worst = next(((n, s) for n, s in row.statuses.items() if s.level == level), ("", None))
    is_said = any(_follows(status, each) for each in causes for status in row.statuses.values())
    has_own = worst and level > Level.OK and not is_said and row.type != "Group"
    remedy = remedy_of(worst, row.id) if worst and has_own else None
    return DisplayRow(
        type=row.type,
        icon=(type(row.display) if row.display else Display).icon,
        name=row.name,
        depth=row.depth,
        enabled=row.enabled,
        can_edit=row.display is not None,
        level=level_name(level),
        # What the viewer says is on top of the list, once.
        line="" if is_said or not worst or level < Level.WARN else _sentence(row, name, worst),
        status=name,
        topics=_topics(row),
        remedy=remedy or msgspec.UNSET,
    )


def _sentence(row: Row, name: str, status: Status) -> str:
    """Return what a status says; that of a group names the display."""
    return f"{name}: {status.text}" if row.type == "Group" or not status.text else status.text


def _topics(row: Row | None) -> list[str]:
    display = row.display if row else None
    return [topic.name for _, _, topic in inputs(display) if topic.name] if display else []


def _rounded(value: float) -> float:
    if not value > 0.0:
        return 0.0
    return float(round(value, 1 - math.floor(math.log10(value))))


def level_name(level: Level) -> LevelName:
    """Return a level as the page calls it."""
    return _LEVELS[level]
