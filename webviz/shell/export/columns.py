"""Values of the points of large clouds, as arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.api.picking import Column
from webviz.engine.pipeline.selectable import ItemColumns
from webviz.shell.export.buffers import Buffers

ColumnChanges = Mapping[tuple[str, str], ItemColumns | None]
"""New columns by store and key, None for those that are gone."""


class ColumnTape:
    """Notes which columns are shown and which of them are new."""

    def __init__(self) -> None:
        self._shown: dict[str, Mapping[str, ItemColumns]] = {}
        self._changes: dict[tuple[str, str], ItemColumns | None] = {}

    def show(self, store: str, columns: Mapping[str, ItemColumns]) -> None:
        """Replace the columns of a store."""
        before = self._shown.get(store, {})
        self._shown[store] = columns
        for key in before.keys() | columns.keys():
            if (new := columns.get(key)) is not before.get(key):
                self._changes[store, key] = new

    def take(self) -> ColumnChanges:
        """Return the changes since the last call."""
        changes, self._changes = self._changes, {}
        return changes


def encoded(each: ItemColumns, kind: str, buffers: Buffers) -> bytes:
    """Return columns as JSON, with their arrays among the buffers of a chunk.

    Args:
        each: the columns of a node.
        kind: of columns that are alike.
        buffers: of the chunk.
    """

    def array(name: str, values: NDArray[Any]) -> dict[str, object]:
        data = _readable(values)
        number = buffers.add(data.data, data.dtype.str, kind=f"{kind} {name}", is_column=True)
        return {"__array": number, "dtype": data.dtype.str}

    columns = each.columns
    values = [
        [
            name,
            {"array": array(name, value.values), "text": value.text}
            if isinstance(value, Column)
            else value,
        ]
        for name, value in columns.values.items()
    ]
    ids = None if each.ids is None else array("#ids", each.ids)
    told = {"title": columns.title, "values": values, "ids": ids}
    place = {"position": columns.position, "origin": columns.origin}
    return msgspec.json.encode({**told, **place})


def _readable(values: NDArray[Any]) -> NDArray[Any]:
    """Return numbers in the smallest type that browsers have for them."""
    kind, size = values.dtype.kind, values.dtype.itemsize
    if kind == "b" or (kind in "iu" and size == 8):
        low, high = (int(values.min()), int(values.max())) if values.size else (0, 0)
        fitting = (t for t in _INTEGERS if np.iinfo(t).min <= low and high <= np.iinfo(t).max)
        dtype = np.dtype(next(fitting, np.float64))
    elif kind == "f":
        dtype = np.dtype(np.float32 if size <= 4 else np.float64)
    else:
        dtype = values.dtype
    return np.ascontiguousarray(values, dtype.newbyteorder("<"))


_INTEGERS = (np.uint8, np.int8, np.uint16, np.int16, np.uint32, np.int32)
