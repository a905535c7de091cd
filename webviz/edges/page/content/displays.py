"""The tree of displays."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from typing import Any

from webviz.api.display import inputs
from webviz.api.status import Level
from webviz.engine.state import Row, State

_LEVELS = {level: level.name.lower() for level in Level}
_CHANGING = re.compile(r"(?<![\w.-])(\d{1,9}(?:\.\d{1,9})?)( (?:s|Hz)\b)")
"""Ages and rates in sentences."""


def displays(state: State, _: str) -> Mapping[str, Any]:
    """The rows by id, and "order": the ids from top to bottom."""
    return {"order": [row.id for row in state.rows], **_rows(state.rows)}


def rate(state: State, id_: str) -> Mapping[str, Any]:
    """Of the display with this id: "hz", how many messages arrive, to two digits; if it listens."""
    row = next((row for row in state.rows if row.id == id_), None)
    known = [state.traffic[name].rate_hz for name in _topics(row) if name in state.traffic]
    return {"hz": _rounded(known[0])} if known else {}


class _Rows:
    """What the page shows of rows, by id; the same object for a row as long as it is the same."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[Row, Mapping[str, Any]]] = {}

    def __call__(self, rows: Iterable[Row]) -> Mapping[str, Mapping[str, Any]]:
        before = self._known
        self._known = now = {
            row.id: known if (known := before.get(row.id)) and known[0] is row else (row, _row(row))
            for row in rows
        }
        return {id_: shown for id_, (_, shown) in now.items()}


_rows = _Rows()


def _row(row: Row) -> Mapping[str, Any]:
    level = row.level
    return {
        "type": row.type,
        "name": row.name,
        "depth": row.depth,
        "enabled": row.enabled,
        "can_edit": row.display is not None,
        "level": level_name(level),
        "line": _worst(row, level),
        "topics": _topics(row),
    }


def _worst(row: Row, level: Level) -> str:
    """The first status of this level if it is a problem; that of a group names the display."""
    if level < Level.WARN:
        return ""
    key, status = next((k, s) for k, s in row.statuses.items() if s.level == level)
    text = f"{key}: {status.text}" if row.type == "Group" or not status.text else status.text
    return _CHANGING.sub(lambda found: f"{_steady(float(found[1])):.9g}{found[2]}", text)


def _topics(row: Row | None) -> list[str]:
    display = row.display if row else None
    return [topic.name for _, _, topic in inputs(display) if topic.name] if display else []


def _steady(value: float) -> float:
    """An age or a rate with so few digits that it does not change all the time."""
    return value if value < 1.0 else _rounded(value) if value >= 10.0 else float(round(value))


def _rounded(value: float) -> float:
    if not value > 0.0:
        return 0.0
    return float(round(value, 1 - math.floor(math.log10(value))))


def level_name(level: Level) -> str:
    """A level as the page calls it: "ok", "warn" and so on."""
    return _LEVELS[level]
