"""Rows of the list of displays, as a panel shows them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from msgspec.structs import replace

from webviz.api.group import DisplayGroup
from webviz.api.registry import type_name
from webviz.api.status import Level, Status, worst_status
from webviz.engine.parts.entry import Entry
from webviz.engine.pipeline import Runner
from webviz.engine.state import Row
from webviz.files.config import Unreadable


def rows(
    entries: Sequence[Entry], statuses_of: Callable[[Runner], Mapping[str, Status]]
) -> tuple[Row, ...]:
    """Return the list for a panel; the statuses of a group summarize the displays in it."""
    rows = [_row(entry, statuses_of) for entry in entries]
    for index, entry in enumerate(entries):
        if isinstance(entry.content, DisplayGroup) and entry.is_enabled:
            inner = [
                row
                for other, row in zip(entries, rows, strict=True)
                if other is not entry and other.is_within(entry)
            ]
            rows[index] = replace(rows[index], statuses=_summary(inner))
    return tuple(rows)


def _row(entry: Entry, statuses_of: Callable[[Runner], Mapping[str, Status]]) -> Row:
    own, content = entry.declared, entry.content
    if isinstance(own, Unreadable):
        status = {"Config": Status(Level.ERROR, own.reason)}
        return Row(entry.id, "", None, own.name, status, entry.depth, own.enabled)
    kind = type_name(type(own))
    statuses: Mapping[str, Status] = {}
    offered: Mapping[str, Mapping[str, int]] = {}
    scale, attribution = None, ""
    if isinstance(content, Runner) and entry.is_enabled:
        statuses, scale = statuses_of(content), content.color_scale()
        offered, attribution = content.offered(), content.attribution()
    common = (entry.id, kind, own, own.name, statuses, entry.depth, own.enabled, scale)
    return Row(*common, entry.revision, offered, attribution)


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
