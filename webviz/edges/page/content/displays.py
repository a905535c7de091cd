"""The tree of displays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.status import Level
from webviz.engine.state import Row, State


def displays(state: State, _: str) -> Mapping[str, Any]:
    """The rows by id, and "order": the ids from top to bottom."""
    rows = {row.id: _row(row) for row in state.rows}
    return {"order": [row.id for row in state.rows], **rows}


def _row(row: Row) -> Mapping[str, Any]:
    worst = next((s for s in row.statuses.values() if s.level == row.level), None)
    return {
        "type": row.type,
        "name": row.name,
        "depth": row.depth,
        "enabled": row.enabled,
        "level": level_name(row.level),
        "line": worst.text if worst is not None and row.level >= Level.WARN else "",
    }


def level_name(level: Level) -> str:
    """A level as the page calls it: "ok", "warn" and so on."""
    return Level(level).name.lower()
