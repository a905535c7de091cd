"""The pictures beside the scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.status import Level
from webviz.engine.state import Row, State
from webviz.page.content.forms import brief, sendable
from webviz.page.content.titles import titles
from webviz.page.content.visibility import enabled, hidden_in


def panes(state: State, _: str) -> Mapping[str, Any]:
    """Return the captions of panes by the id of their display, and "order": the ids.

    Each has a "title", the "name" of its display, the first "problem" of the worst, and whether it
    "has_picture"; one that draws the scene, too, the ids of displays that are "hidden" in it.
    """
    rows = [row for row in enabled(state.rows) if row.display and type(row.display).has_pane]
    titled = titles(rows)
    about = {row.id: {"title": titled[row.id], **_about(row)} for row in rows}
    for display, ids in hidden_in(rows, state.rows).items():
        about[display]["hidden"] = ids
    return {"order": [row.id for row in rows], **about}


def _about(row: Row) -> dict[str, Any]:
    level = row.level
    problem = ""
    if level > Level.OK:
        problem = next(status.text for status in row.statuses.values() if status.level is level)
    has_picture = level is not Level.ERROR
    return {"name": sendable(row.name), "problem": brief(problem), "has_picture": has_picture}
