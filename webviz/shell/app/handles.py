"""A display of a viewer, for Python programs."""

from __future__ import annotations

import copy
import time
from collections.abc import Iterable, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as FutureTimeout
from dataclasses import replace
from typing import Any, Protocol

from webviz.api.errors import Error
from webviz.api.status import Level, Status
from webviz.engine.commands import (
    Command,
    DuplicateDisplay,
    FocusDisplay,
    MoveDisplay,
    RemoveDisplay,
    SetProperty,
    TraceDisplay,
)
from webviz.engine.state import Row, State
from webviz.engine.trace import Trace
from webviz.shell.app.adding import NoSuchProperty, no_property


class NoSuchDisplay(Error, LookupError):
    """There is no display of that name or number, or several, or it was removed."""


class Owner(Protocol):
    """What a handle needs of its viewer; see `webviz.Viewer`."""

    @property
    def state(self) -> State:
        """A snapshot of the viewer."""
        ...

    def do(self, command: Command) -> str:
        """Change something, and wait until it is done."""
        ...

    def acknowledged(self, timeout: float) -> bool:
        """Wait until every browser has applied all that was sent so far; whether they did."""
        ...


class DisplayHandle:
    """A display or a group, wherever it is in the list.

    Its properties are attributes, named and checked as in config files: `scan.size = 0.1`. A nested
    one is set by a dotted path or in part: `scan.set("topic.depth", 1)`, `scan.topic = {"depth":
    1}`.

    Args:
        viewer: that shows it.
        id: of the display.
    """

    __slots__ = ("_viewer", "id")

    id: str
    _viewer: Owner

    def __init__(self, viewer: Owner, id: str) -> None:
        object.__setattr__(self, "_viewer", viewer)
        object.__setattr__(self, "id", id)

    @property
    def type(self) -> str:
        """Name of the display type; "" for an entry of a config that cannot be shown."""
        return self._row().type

    @property
    def status(self) -> Status:
        """The worst of its statuses."""
        return _worst(self._row())

    @property
    def statuses(self) -> dict[str, Status]:
        """Sentences by key, as the panel shows them."""
        return dict(self._row().statuses)

    @property
    def displays(self) -> list[DisplayHandle]:
        """What is in a group, in order; a group in it is one of them."""
        _, behind = self._around()
        inner = []
        for row in behind[1:]:
            if row.depth <= behind[0].depth:
                break
            if row.depth == behind[0].depth + 1:
                inner.append(DisplayHandle(self._viewer, row.id))
        return inner

    def set(self, path: str, value: Any) -> None:
        """Set a property, a nested one by a dotted path such as `topic.depth`.

        Raises:
            Error: there is no such property, or the value does not fit; nothing was changed.
        """
        _check(self._row(), path.partition(".")[0])
        self._viewer.do(SetProperty(self.id, path, value))

    def remove(self) -> None:
        """Remove it, a group with all that is in it."""
        self._row()
        self._viewer.do(RemoveDisplay(self.id))

    def focus(self) -> None:
        """Let every browser look at all that it draws, or what is in a group.

        Raises:
            Error: no browser is open, or nothing of it is drawn.
        """
        self._row()
        self._viewer.do(FocusDisplay(self.id))

    def trace(self, timeout: float = 5.0) -> Trace:
        """Wait for the next sample that it draws, and return when that was where.

        A browser has to be connected, for nothing is drawn without one. Times are collected only
        while this waits.

        Args:
            timeout: seconds, for the sample and for the browsers in turn.

        Raises:
            Error: it drew no new sample in time.
        """
        name = self._row().name
        answer: Future[Trace] = Future()
        answer.add_done_callback(lambda _: sent_s.append(time.monotonic()))
        sent_s: list[float] = []
        self._viewer.do(TraceDisplay(self.id, answer))
        try:
            trace = answer.result(timeout)
        except FutureTimeout:
            answer.cancel()
            raise Error(
                f"{name} drew no new sample within {timeout:g} s. Check its status, and open the "
                "page in a browser."
            ) from None
        if not self._viewer.acknowledged(timeout):
            return trace
        elapsed_ns = round((time.monotonic() - sent_s[0]) * 1e9)
        return replace(trace, acknowledged_ns=trace.sent_ns + elapsed_ns)

    def duplicate(self) -> DisplayHandle:
        """Add a copy right behind it, of a group with all that is in it."""
        self._row()
        made: list[str] = []
        self._viewer.do(DuplicateDisplay(self.id, made.append))
        return DisplayHandle(self._viewer, made[0])

    def move(
        self, *, group: DisplayHandle | None = None, before: DisplayHandle | None = None
    ) -> None:
        """Put it elsewhere in the list.

        Args:
            group: where to; None is the group of `before`, or the list itself.
            before: goes before this one; None is the end.

        Raises:
            Error: there is no such place.
        """
        self._row()
        if group is None and before is not None:
            group = before._parent()
        if group is not None and group.type != "Group":
            raise Error(f"{group.name} is not a group.")
        if before is not None and before._parent() != group:
            raise Error(f"{before.name} is in another group.")
        if group is not None and self in [group, *group._ancestors()]:
            raise Error(f"{self.name} cannot be moved into itself.")
        ids = [handle.id if handle is not None else "" for handle in (group, before)]
        self._viewer.do(MoveDisplay(self.id, *ids))

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):  # which people's tools try
            raise AttributeError(name)
        row = self._row()
        if row.display is None and name == "name":
            return row.name
        _check(row, name)
        value = getattr(row.display, name)
        # A list that is changed in place would not be checked.
        return copy.deepcopy(value) if isinstance(value, list | dict) else value

    def __setattr__(self, name: str, value: Any) -> None:
        if hasattr(type(self), name):
            raise NoSuchProperty(f"`{name}` of a display cannot be set.")
        self.set(name, value)

    def __dir__(self) -> Iterable[str]:
        row = self._find()
        properties = row.display.__struct_fields__ if row and row.display else ()
        return [*object.__dir__(self), *properties]

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, DisplayHandle)
            and self._viewer is other._viewer
            and self.id == other.id
        )

    def __hash__(self) -> int:
        return hash(self.id)

    def __repr__(self) -> str:
        row = self._find()
        if row is None:
            return "<a display that was removed>"
        status = _worst(row)
        return f"<{row.type or 'unreadable'} {row.name!r}: {status.level.name} {status.text}>"

    def _find(self) -> Row | None:
        return next((row for row in self._viewer.state.rows if row.id == self.id), None)

    def _around(self) -> tuple[Sequence[Row], Sequence[Row]]:
        """What is before it in the list, and what is from it on."""
        rows = self._viewer.state.rows
        for number, row in enumerate(rows):
            if row.id == self.id:
                return rows[:number], rows[number:]
        raise NoSuchDisplay("This display was removed: take another one.")

    def _row(self) -> Row:
        return self._around()[1][0]

    def _parent(self) -> DisplayHandle | None:
        """The group it is in."""
        before, behind = self._around()
        outer = [row for row in before if row.depth == behind[0].depth - 1]
        return DisplayHandle(self._viewer, outer[-1].id) if outer else None

    def _ancestors(self) -> list[DisplayHandle]:
        parent = self._parent()
        return [parent, *parent._ancestors()] if parent is not None else []


def _worst(row: Row) -> Status:
    return max(row.statuses.values(), key=lambda status: status.level, default=Status(Level.OK, ""))


def _check(row: Row, name: str) -> None:
    """Refuse a property that a display has not."""
    if row.display is None:
        reason = " ".join(status.text for status in row.statuses.values())
        raise NoSuchProperty(f"{row.name} cannot be shown, so it has no properties: {reason}")
    if name not in row.display.__struct_fields__:
        raise NoSuchProperty(no_property(row.type, name, row.display.__struct_fields__))
