"""Statuses and properties of one display."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.edges.page.content.displays import level_name
from webviz.engine.state import State


def properties(state: State, id_: str) -> Mapping[str, Any]:
    """Of the display with this id: "statuses"; nothing if it is gone."""
    row = next((row for row in state.rows if row.id == id_), None)
    if row is None:
        return {}
    return {"statuses": [[key, level_name(s.level), s.text] for key, s in row.statuses.items()]}
