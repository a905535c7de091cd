"""Messages as trees that JSON can hold, with limits on their size."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime
from itertools import islice
from typing import Any

import numpy as np

from webviz.data.messages.geometry import NANOSECONDS, Duration, Time
from webviz.data.messages.value_names import NO_NAMES, named, names_in

MAX_NODES = 500
"""Fields and elements of a message in all."""
_ARRAY_HEAD = 20
"""Number of items kept of an array."""
_LIST_HEAD = 10
"""Number of elements kept of a sequence of messages."""
_STRING_HEAD = 400
"""Number of characters kept of a string: robot descriptions have a million."""

_YEAR_NS = 31_536_000 * NANOSECONDS

Tree = str | dict[str, Any]


def to_tree(
    message: Any,
    max_nodes: int = MAX_NODES,
    *,
    digits: int = 9,
    max_items: int | None = None,
    is_readable: bool = False,
) -> Tree:
    """Return a message without what is too long to read.

    Args:
        message: what `decode` returned, or a value in it.
        max_nodes: fields and elements that are kept at most.
        digits: significant digits of numbers; 9 are what a float32 needs, and millimetres in UTM
            coordinates.
        max_items: elements of a sequence that are kept; None for 20 numbers or 10 messages.
        is_readable: times as dates and durations in seconds, instead of their two fields.

    Returns:
        A value is its text as in `ros2 topic echo`, or "DISCHARGING (2)" where the type has a
        constant for it. A message is {"fields": {name: tree}}, a
        sequence {"length": of all, "type": of its numbers or "", "items": [the first]}. Where not
        all of a message fits, its last field is "…".
    """
    return _Maker(max_nodes, digits, max_items, is_readable).tree(message)


def time_text(ns: int) -> str:
    """Return a time as a date in UTC; within a year of 0, as simulations have it, in seconds."""
    if ns < _YEAR_NS:
        return f"{ns / NANOSECONDS:.3f} s"
    seconds, rest = divmod(ns, NANOSECONDS)
    return f"{datetime.fromtimestamp(seconds, UTC):%Y-%m-%d %H:%M:%S}.{rest // 10**6:03d} UTC"


class _Maker:
    """Makes one tree.

    Args:
        rest: how many nodes may still be made.
        digits, max_items, is_readable: see `to_tree`.
    """

    def __init__(self, rest: int, digits: int, max_items: int | None, is_readable: bool) -> None:
        self._rest = rest
        self._format = f".{digits}g"
        self._array_head = _ARRAY_HEAD if max_items is None else max_items
        self._list_head = _LIST_HEAD if max_items is None else max_items
        self._is_readable = is_readable

    def tree(self, value: Any) -> Tree:
        if self._is_readable and isinstance(value, Time):
            return time_text(value.ns)
        if self._is_readable and isinstance(value, Duration):
            return f"{self._number(value.ns / NANOSECONDS)} s"
        if names := field_names(value):
            return {"fields": self._fields(value, names)}
        if isinstance(value, str):
            more = f" … ({len(value)} characters)" if len(value) > _STRING_HEAD else ""
            return repr(value[:_STRING_HEAD]) + more
        if isinstance(value, np.ndarray):
            numbers = value.ravel()[: self._array_head].tolist()
            type_name = " x ".join([*map(str, value.shape[1:]), str(value.dtype)])
            return self._sequence(value.size and len(value), type_name, map(self._number, numbers))
        if hasattr(value, "__len__"):
            head = list(islice(value, self._list_head))
            return self._sequence(len(value), "", map(self.tree, head))
        return self._number(value)

    def _fields(self, message: Any, names: Iterable[str]) -> dict[str, Tree]:
        fields: dict[str, Tree] = {}
        by_field = names_in(message)
        for name in names:
            if self._rest <= 0:
                fields["…"] = "more than is shown here"
                break
            self._rest -= 1
            value = getattr(message, name)
            fields[name] = named(value, by_field.get(name, NO_NAMES)) or self.tree(value)
        return fields

    def _sequence(self, length: int, type_name: str, items: Iterable[Tree]) -> Tree:
        branches: list[Tree] = []
        for item in items:
            if self._rest <= 0:
                break
            self._rest -= 1
            branches.append(item)
        return {"length": length, "type": type_name, "items": branches}

    def _number(self, value: Any) -> str:
        if isinstance(value, np.floating):
            value = float(value)
        return format(value, self._format) if isinstance(value, float) else str(value)


def field_names(value: Any) -> tuple[str, ...]:
    """Names of the fields of a message; empty for anything else."""
    if hasattr(type(value), "__getitem__") and not hasattr(value, "_fields"):
        return ()  # a sequence, also if it is built as a struct of arrays
    return getattr(value, "__struct_fields__", None) or getattr(value, "_fields", ())
