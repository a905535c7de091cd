"""Rows of the list of displays: as parts read them, and as pages show the tree."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import ClassVar

import msgspec
from msgspec.structs import replace

from webviz.api.display import Display, inputs
from webviz.api.finding import Symptom
from webviz.api.group import DisplayGroup
from webviz.api.registry import type_name
from webviz.api.status import Level, Status, worst_status
from webviz.engine.parts.entry import Entry
from webviz.engine.parts.status_lines import (
    LevelName,
    RemedyButton,
    follows,
    level_name,
    remedy_of,
)
from webviz.engine.pipeline import Runner
from webviz.engine.pipeline.renderer import DrawReport
from webviz.engine.state import Row
from webviz.engine.store import PageStore
from webviz.files.config import Unreadable


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


def rows(
    entries: Sequence[Entry],
    statuses_of: Callable[[Runner], Mapping[str, Status]],
    before: tuple[Row, ...] = (),
) -> tuple[Row, ...]:
    """Return the list; the statuses of a group summarize the displays in it.

    Args:
        entries: of the list.
        statuses_of: returns those of a display.
        before: the last list; rows that are the same, and the list, are the same objects.
    """
    rows = [_row(entry, statuses_of) for entry in entries]
    for index, entry in enumerate(entries):
        if isinstance(entry.content, DisplayGroup) and entry.is_enabled:
            inner = [
                row
                for other, row in zip(entries, rows, strict=True)
                if other is not entry and other.is_within(entry)
            ]
            rows[index] = replace(rows[index], statuses=_summary(inner))
    former = {row.id: row for row in before}
    now = tuple(_same(row, former.get(row.id)) for row in rows)
    return before if now == before else now


def _same(row: Row, before: Row | None) -> Row:
    is_same = before is not None and row.display is before.display and row == before
    return before if is_same and before else row


def _row(entry: Entry, statuses_of: Callable[[Runner], Mapping[str, Status]]) -> Row:
    own, content = entry.declared, entry.content
    if isinstance(own, Unreadable):
        status = {"Config": Status(Level.ERROR, own.reason)}
        return Row(entry.id, "", None, own.name, status, entry.depth, own.enabled)
    kind = type_name(type(own))
    statuses: Mapping[str, Status] = {}
    report = DrawReport()
    if isinstance(content, Runner) and entry.is_enabled:
        statuses, report = statuses_of(content), content.report()
    common = (entry.id, kind, own, own.name, statuses, entry.depth, own.enabled)
    return Row(*common, report.color_scale, entry.revision, report.offered, report.attribution)


def _summary(rows: Iterable[Row]) -> dict[str, Status]:
    """Return the statuses of a group: the worst of each display in it that has a problem.

    A group whose displays are all idle is idle.
    """
    rows = list(rows)
    is_idle = all(row.level is Level.IDLE for row in rows)
    return {
        row.name: worst_status(row.statuses.values())
        for row in rows
        if row.level > Level.OK or is_idle
    }


class TreeRows:
    """Rows as the page shows them, by id; the same object for a row as long as it is unchanged."""

    def __init__(self) -> None:
        self._cache: dict[str, tuple[Row, DisplayRow]] = {}
        self._causes: tuple[Status, ...] = ()

    def __call__(self, rows: Iterable[Row], causes: tuple[Status, ...]) -> Mapping[str, DisplayRow]:
        """Return those of these rows; see `webviz.engine.parts.status_lines.causes`."""
        before = self._cache if causes == self._causes else {}
        self._causes = causes
        self._cache = now = {
            row.id: entry
            if (entry := before.get(row.id)) and entry[0] is row
            else (row, _display_row(row, causes))
            for row in rows
        }
        return {id_: row_view for id_, (_, row_view) in now.items()}


def _display_row(row: Row, causes: Sequence[Status]) -> DisplayRow:
    level = row.level
    name, worst = next(((n, s) for n, s in row.statuses.items() if s.level == level), ("", None))
    is_said = any(follows(status, each) for each in causes for status in row.statuses.values())
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
        topics=topics_of_row(row),
        remedy=remedy or msgspec.UNSET,
    )


def _sentence(row: Row, name: str, status: Status) -> str:
    """Return what a status says; that of a group names the display."""
    return f"{name}: {status.text}" if row.type == "Group" or not status.text else status.text


def topics_of_row(row: Row | None) -> list[str]:
    """Return the topics that a display subscribes to, in the order of its inputs."""
    display = row.display if row else None
    return [topic.name for _, _, topic in inputs(display) if topic.name] if display else []


def problems(statuses: Mapping[str, Status], rows: Sequence[Row]) -> Mapping[Symptom, Status]:
    """Return the warnings and errors of the viewer and of its displays, without groups."""
    owners = [("", statuses)]
    owners += [(row.id, row.statuses) for row in rows if not is_group(row)]
    return {
        Symptom(id, key): status
        for id, statuses in owners
        for key, status in statuses.items()
        if status.level >= Level.WARN
    }


def is_group(row: Row) -> bool:
    """Return whether a row is a group of others."""
    return isinstance(row.display, DisplayGroup)
