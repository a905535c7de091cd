"""The pictures beside the scene."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from webviz.api.status import Level
from webviz.edges.page.content.forms import brief, sendable
from webviz.edges.page.content.visibility import hidden_in
from webviz.engine.state import Row, State


def panes(state: State, _: str) -> Mapping[str, Any]:
    """What is said about each pane by the id of its display, and "order": the ids.

    Each has a "name", the first "problem" of the worst, and whether it "has_picture"; one that
    draws the scene, too, the ids of displays that are "hidden" in it.
    """
    rows = list(_visible(state.rows))
    about = {row.id: _about(row) for row in rows}
    for display, ids in hidden_in(rows, state.rows).items():
        about[display]["hidden"] = ids
    return {"order": [row.id for row in rows], **about}


def _visible(rows: tuple[Row, ...]) -> Iterator[Row]:
    """Those with a pane that are on, and not in a group that is off."""
    off: int | None = None
    for row in rows:
        if off is not None and row.depth > off:
            continue
        off = None if row.enabled else row.depth
        if row.enabled and row.display is not None and type(row.display).has_pane:
            yield row


def _about(row: Row) -> dict[str, Any]:
    level = row.level
    problem = ""
    if level is not Level.OK:
        problem = next(status.text for status in row.statuses.values() if status.level is level)
    has_picture = level is not Level.ERROR
    return {"name": sendable(row.name), "problem": brief(problem), "has_picture": has_picture}
