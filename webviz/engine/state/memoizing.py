"""Memoised parts of a state: unchanged ones are reused, so that panels skip them."""

from __future__ import annotations

from typing import Any

from msgspec.structs import replace

from webviz.engine.state.state import Row, State

_COMPARED = (
    *("frames", "statuses", "file", "traffic", "views", "history"),
    *("playback", "selected", "selections"),
)
"""Fields that are made anew for each state, and cannot change within."""


def reuse_unchanged(state: State, before: State) -> State:
    """Return the same state, of the very objects of the one before wherever they are equal."""
    kept: dict[str, Any] = {
        name: old for name in _COMPARED if (old := getattr(before, name)) == getattr(state, name)
    }
    known = {row.id: row for row in before.rows}
    rows = tuple(_reuse_row(row, known.get(row.id)) for row in state.rows)
    return replace(state, rows=before.rows if rows == before.rows else rows, **kept)


def _reuse_row(row: Row, before: Row | None) -> Row:
    if before is None or row.display is not before.display or row != before:
        return row
    return before
