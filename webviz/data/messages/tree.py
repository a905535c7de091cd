"""Messages as trees that JSON can hold, with limits on their size."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice
from typing import Any

import numpy as np

MAX_NODES = 500
"""Fields and elements of a message in all."""
_ARRAY_HEAD = 20
"""How many numbers of an array are kept."""
_LIST_HEAD = 10
"""How many elements of a sequence of messages are kept."""
_STRING_HEAD = 400
"""How many characters of a string are kept: robot descriptions have a million."""

Tree = str | dict[str, Any]


def to_tree(message: Any, max_nodes: int = MAX_NODES) -> Tree:
    """A message without what is too long to read.

    Args:
        message: what `decode` returned.
        max_nodes: fields and elements that are kept at most.

    Returns:
        A value is its text as in `ros2 topic echo`. A message is {"fields": {name: tree}}, a
        sequence {"length": of all, "type": of its numbers or "", "items": [the first]}. Where not
        all of a message fits, its last field is "…".
    """
    return _Maker(max_nodes).tree(message)


class _Maker:
    """Makes one tree.

    Args:
        rest: how many nodes may still be made.
    """

    def __init__(self, rest: int) -> None:
        self._rest = rest

    def tree(self, value: Any) -> Tree:
        if names := _names(value):
            return {"fields": self._fields(value, names)}
        if isinstance(value, str):
            more = f" … ({len(value)} characters)" if len(value) > _STRING_HEAD else ""
            return repr(value[:_STRING_HEAD]) + more
        if isinstance(value, np.ndarray):
            numbers = value.ravel()[:_ARRAY_HEAD].tolist()
            type_name = " x ".join([*map(str, value.shape[1:]), str(value.dtype)])
            return self._sequence(value.size and len(value), type_name, map(_number, numbers))
        if hasattr(value, "__len__"):
            head = list(islice(value, _LIST_HEAD))
            return self._sequence(len(value), "", map(self.tree, head))
        return _number(value)

    def _fields(self, message: Any, names: Iterable[str]) -> dict[str, Tree]:
        fields: dict[str, Tree] = {}
        for name in names:
            if self._rest <= 0:
                fields["…"] = "more than is shown here"
                break
            self._rest -= 1
            fields[name] = self.tree(getattr(message, name))
        return fields

    def _sequence(self, length: int, type_name: str, items: Iterable[Tree]) -> Tree:
        kept: list[Tree] = []
        for item in items:
            if self._rest <= 0:
                break
            self._rest -= 1
            kept.append(item)
        return {"length": length, "type": type_name, "items": kept}


def _number(value: Any) -> str:
    """Nine significant digits: what a float32 needs, and millimetres in UTM coordinates."""
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _names(value: Any) -> tuple[str, ...]:
    """Names of the fields of a message; empty for anything else."""
    if hasattr(type(value), "__getitem__") and not hasattr(value, "_fields"):
        return ()  # a sequence, also if it is built as a struct of arrays
    return getattr(value, "__struct_fields__", None) or getattr(value, "_fields", ())
