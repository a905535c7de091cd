"""Selection of one browser."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.engine.state import State


def selection(state: State, browser: str) -> Mapping[str, Any]:
    """Return the details of each selected item by its id, and "/info" on all of them.

    A thing has the id and the "name" of its "display", a "title", a "tree" of values, and a "note".
    "/info" has their "total" before any limit, the "count" of those selected, and how many are
    kept "live" at most; of several things also, for each of their "displays", its "name", the
    "count", and of numbers the "ranges": "name", "unit", "low", "high" and "mean".
    """
    return _of(browser, state.selections)


def selected(state: State, browser: str) -> Mapping[str, Any]:
    """By the id of each thing, that of its display, and whether it moves and stays what it is."""
    return {str(id): each for id, each in _of(browser, state.selected).items()}


def picking(state: State, _: str) -> Mapping[str, Any]:
    """The ids of displays that are not "selectable", each with False.

    A page watches it while it is about to select.
    """
    return {row.id: False for row in state.rows if not getattr(row.display, "selectable", True)}


def _of(browser: str, known: Mapping[int, Mapping[Any, Any]]) -> Mapping[Any, Any]:
    return known.get(int(browser), {}) if browser.isdecimal() else {}
