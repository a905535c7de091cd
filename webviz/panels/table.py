"""The panel Table: the elements of an array as rows."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

import numpy as np

from webviz.api.offer import Offer
from webviz.api.panel import Send, Ui
from webviz.data.messages.paths import as_number
from webviz.data.messages.tree import field_names
from webviz.data.messages.value_names import NO_NAMES, named, names_in
from webviz.data.names import readable
from webviz.data.words import counted
from webviz.engine.state import PanelTab
from webviz.panels.one_path import PathPanel

MAX_ROWS, MAX_COLUMNS = 1000, 30
MAX_TEXT = 200
"""Characters of a cell."""
MAX_CHARACTERS = 200_000
"""Largest number of characters of all cells; of more, the first rows are shown."""
MAX_DEPTH = 4
COMPONENTS = "xyzw"

Cell = float | str


class MessageTable(PathPanel):
    """The elements of an array, or of what a filter finds, as rows of a table."""

    title = "Table"
    icon = "grid"
    opens = "below"
    module = "table.js"

    def build(self, ui: Ui, send: Send) -> None:
        """Show the path and the table."""
        self.build_path(ui, send)
        self.table = ui.widget("table", {}, lambda value, browser: None)
        self.drawn_revision = -1
        self.content: dict[str, Any] = {"columns": [], "rows": [], "note": ""}

    def show(self, offers: Mapping[str, Offer], panels: Sequence[PanelTab]) -> None:
        """Show the newest values."""
        problem = self.follow(offers, panels)
        if self.drawn_revision != self.revision:
            self.drawn_revision, self.content = self.revision, table_of(self.values)
        self.table.show({**self.content, "problem": problem})


def table_of(values: list[Any]) -> dict[str, Any]:
    """Return the columns and rows of values; one array is its elements."""
    items: Any = values
    if len(values) == 1 and _is_array(values[0]):
        items = values[0]
    rows = []
    columns: dict[str, None] = {}
    size = 0
    for item in islice(items, MAX_ROWS):
        row = dict(islice(_cells(item, "", MAX_DEPTH), MAX_COLUMNS))
        size += sum(len(str(cell)) for cell in row.values())
        if size > MAX_CHARACTERS:
            break
        rows.append(row)
        columns.update(dict.fromkeys(row))
    names = list(columns)[:MAX_COLUMNS]
    rest = len(items) - len(rows)
    return {
        "columns": [name or "value" for name in names],
        "rows": [[row.get(name, "") for name in names] for row in rows],
        "note": f"{counted(rest, 'row')} more." if rest > 0 else "",
    }


def _cells(value: Any, path: str, depth: int) -> Iterator[tuple[str, Cell]]:
    """Yield the cells of an element by the paths of their fields; arrays are their length."""
    number = as_number(value)
    if number is not None:
        yield path, number if math.isfinite(number) else str(number)
    elif isinstance(value, str):
        yield path, readable(value[:MAX_TEXT])
    elif names := field_names(value):
        by_field = names_in(value)
        for name in names if depth else ():
            inner = f"{path}.{name}" if path else name
            item = getattr(value, name)
            if text := named(item, by_field.get(name, NO_NAMES)):
                yield inner, text
            else:
                yield from _cells(item, inner, depth - 1)
    elif isinstance(value, np.ndarray) and value.ndim == 1 and len(value) <= len(COMPONENTS):
        for name, item in zip(COMPONENTS, value, strict=False):
            yield from _cells(item, f"{path}.{name}" if path else name, depth - 1)
    elif hasattr(value, "__len__"):
        yield path, counted(len(value), "element")


def _is_array(value: Any) -> bool:
    return hasattr(value, "__len__") and not isinstance(value, str) and not field_names(value)
