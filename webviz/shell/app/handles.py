"""Handles of displays for Python programs."""

from __future__ import annotations

import copy
import time
from collections.abc import Iterable, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as FutureTimeout
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from webviz.api.errors import Error
from webviz.api.finding import Finding
from webviz.api.status import Status, worst_status
from webviz.commands import (
    DuplicateDisplay,
    FocusDisplay,
    MoveDisplay,
    RemoveDisplay,
    SetProperty,
    TraceDisplay,
)
from webviz.data.words import joined
from webviz.engine.commands import Command
from webviz.engine.pipeline.trace import Trace
from webviz.engine.state import Row
from webviz.shell.app.adding import NoSuchProperty, no_property

if TYPE_CHECKING:
    from webviz.shell.app.running import Running


class NoSuchDisplay(Error, LookupError):
    """A display does not exist, was removed, or its name is ambiguous."""


class DisplayHandle:
    """A display or group.

    Its properties are attributes, named and checked as in config files: `scan.size = 0.1`. Set
    nested ones by a dotted path or in part: `scan.set("topic.depth", 1)`, `scan.topic = {"depth":
    1}`.
    """

    __slots__ = ("_viewer", "id")

    id: str
    _viewer: Running

    def __init__(self, viewer: Running, id: str) -> None:
        object.__setattr__(self, "_viewer", viewer)
        object.__setattr__(self, "id", id)

    @property
    def type(self) -> str:
        """Name of the display type; "" for an invalid entry of a config."""
        return self._row().type

    @property
    def status(self) -> Status:
        """The worst of its statuses."""
        return _worst(self._row())

    @property
    def statuses(self) -> dict[str, Status]:
        """All statuses by key, as in the panel."""
        return dict(self._row().statuses)

    @property
    def findings(self) -> list[Finding]:
        """The findings of `Viewer.doctor` that explain its statuses, as of its last round."""
        own = self._row().id
        return [
            finding
            for finding in self._viewer.fact("findings")
            if own in {symptom.display for symptom in finding.explains}
        ]

    @property
    def displays(self) -> list[DisplayHandle]:
        """The displays and groups directly in a group, in order."""
        _, behind = self._around()
        inner = []
        for row in behind[1:]:
            if row.depth <= behind[0].depth:
                break
            if row.depth == behind[0].depth + 1:
                inner.append(DisplayHandle(self._viewer, row.id))
        return inner

    def set(self, path: str, value: Any) -> None:
        """Set a property; `path` is dotted for a nested one, such as `topic.depth`.

        Raises:
            Error: the property is unknown, or the value is invalid; nothing was changed.
        """
        _check(self._row(), path.partition(".")[0])
        self._viewer.do(SetProperty(self.id, path, value))

    def remove(self) -> None:
        """Remove the display, or the group with its contents."""
        self._do(RemoveDisplay(self.id))

    def focus(self) -> None:
        """Point the cameras of all browsers at the display, or at the contents of the group.

        Raises:
            Error: no browser is connected, or the display draws nothing.
        """
        self._do(FocusDisplay(self.id))

    def trace(self, timeout: float = 5.0) -> Trace:
        """Wait for the next sample that the display draws, and return its timing.

        Requires a connected browser, since nothing is drawn without one. Times are recorded only
        during this call.

        Args:
            timeout: in seconds, for the sample and for the browsers each.

        Raises:
            Error: the display drew no new sample in time.
        """
        name = self._row().name
        answer: Future[Trace] = Future()
        # A thread that waits for a future may go on before its callbacks are called.
        sent: Future[float] = Future()
        answer.add_done_callback(lambda _: sent.set_result(time.monotonic()))
        self._viewer.do(TraceDisplay(self.id, answer))
        try:
            sent_s = sent.result(timeout)
        except FutureTimeout:
            answer.cancel()
            raise Error(
                f"{name} drew no new sample within {timeout:g} s. Check its status, and open the "
                "page in a browser."
            ) from None
        trace = answer.result(0)
        if not self._viewer.acknowledged(timeout):
            return trace
        elapsed_ns = round((time.monotonic() - sent_s) * 1e9)
        return replace(trace, acknowledged_ns=trace.sent_ns + elapsed_ns)

    def duplicate(self) -> DisplayHandle:
        """Add a copy below the display; that of a group includes its contents."""
        ids: list[str] = []
        self._do(DuplicateDisplay(self.id, ids.append))
        return DisplayHandle(self._viewer, ids[0])

    def move(
        self, *, group: DisplayHandle | None = None, before: DisplayHandle | None = None
    ) -> None:
        """Move the display in the list.

        Args:
            group: target group; None for the group of `before`, or the top level.
            before: the display to insert it before; None for the end.

        Raises:
            Error: the target is invalid.
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
        if name.startswith("_"):  # looked up by notebooks, copy and pickle
            raise AttributeError(name)
        row = self._row()
        if row.display is None and name == "name":
            return row.name
        _check(row, name)
        value = getattr(row.display, name)
        # Changing a list in place would bypass the checks.
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
            return "<removed display>"
        status = _worst(row)
        return f"<{row.type or 'unreadable'} {row.name!r}: {status.level.name} {status.text}>"

    def _do(self, command: Command) -> None:
        self._row()  # raises if it was removed
        self._viewer.do(command)

    def _find(self) -> Row | None:
        return next((row for row in self._viewer.rows if row.id == self.id), None)

    def _around(self) -> tuple[Sequence[Row], Sequence[Row]]:
        """Return the rows before the display, and those from it on."""
        rows = self._viewer.rows
        for number, row in enumerate(rows):
            if row.id == self.id:
                return rows[:number], rows[number:]
        raise NoSuchDisplay("This display was removed.")

    def _row(self) -> Row:
        return self._around()[1][0]

    def _parent(self) -> DisplayHandle | None:
        """Return the group that contains the display."""
        before, behind = self._around()
        outer = [row for row in before if row.depth == behind[0].depth - 1]
        return DisplayHandle(self._viewer, outer[-1].id) if outer else None

    def _ancestors(self) -> list[DisplayHandle]:
        parent = self._parent()
        return [parent, *parent._ancestors()] if parent is not None else []


def _worst(row: Row) -> Status:
    return worst_status(row.statuses.values())


def _check(row: Row, name: str) -> None:
    """Refuse an unknown property."""
    if row.display is None:
        reason = joined(*(status.text for status in row.statuses.values()))
        raise NoSuchProperty(f"{row.name} is invalid and has no properties: {reason}")
    if name not in row.display.__struct_fields__:
        raise NoSuchProperty(no_property(row.type, name, row.display.__struct_fields__))
