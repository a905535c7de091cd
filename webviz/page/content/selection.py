"""Selection of one browser."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, TypeVar

import msgspec

from webviz.engine.state import State
from webviz.engine.store import PageStore

_T = TypeVar("_T")


class Thing(msgspec.Struct, frozen=True):
    """A selected item.

    Args:
        display, name: id and name of its display.
        title: of the item.
        tree: of values, see `webviz.data.messages.to_tree`.
        note: a sentence, or "".
    """

    display: str
    name: str
    title: str
    tree: Mapping[str, Any]
    note: str


class ValueRange(msgspec.Struct, frozen=True):
    """Numbers of several items, see `webviz.engine.pipeline.statistics.Range`."""

    name: str
    unit: str
    low: float
    high: float
    mean: float


class DisplayShare(msgspec.Struct, frozen=True):
    """The items of one display: its name, their number, and the extents of their numbers."""

    name: str
    count: int
    ranges: Sequence[ValueRange]


class SelectionInfo(msgspec.Struct, frozen=True):
    """All items.

    Args:
        total: before any limit.
        live: how many are kept up to date at most.
        count: of those selected.
        displays: of several items.
    """

    total: int
    live: int
    count: int
    displays: Sequence[DisplayShare] | msgspec.UnsetType = msgspec.UNSET


class SelectionStore(PageStore, frozen=True):
    """The selection of a browser: the items by id, and "/info" on all of them."""

    spread: ClassVar = {"things": ""}

    things: Mapping[str, Thing]
    info: SelectionInfo | msgspec.UnsetType = msgspec.field(name="/info", default=msgspec.UNSET)


class SelectedStore(PageStore, frozen=True):
    """By the id of each item, that of its display, and whether it moves and stays what it is."""

    spread: ClassVar = {"things": ""}

    things: Mapping[str, tuple[str, bool]]


class PickingStore(PageStore, frozen=True):
    """The ids of displays that are not selectable, each with False."""

    spread: ClassVar = {"selectable": ""}

    selectable: Mapping[str, bool]


def selection(state: State, browser: str) -> SelectionStore:
    """Return the details of what a browser has selected."""
    known = _of(browser, state.selections)
    things = {id: Thing(**each) for id, each in known.items() if id != "/info"}
    return SelectionStore(
        things, SelectionInfo(**known["/info"]) if "/info" in known else msgspec.UNSET
    )


def selected(state: State, browser: str) -> SelectedStore:
    """Return what a browser has selected."""
    return SelectedStore({str(id): each for id, each in _of(browser, state.selected).items()})


def picking(state: State, _: str) -> PickingStore:
    """Return which displays are not selectable; a page watches it while it is about to select."""
    rows = (row for row in state.rows if not getattr(row.display, "selectable", True))
    return PickingStore({row.id: False for row in rows})


def _of(browser: str, known: Mapping[int, Mapping[Any, _T]]) -> Mapping[Any, _T]:
    return known.get(int(browser), {}) if browser.isdecimal() else {}
