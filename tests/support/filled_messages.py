"""Messages of any distribution, each value of which differs from the others."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from rosbags.interfaces import Nodetype


def filled(store: Any, name: str, numbers: Iterator[int]) -> Any:
    """Return a message of a distribution in which each value differs from the others."""
    values = {}
    for field, (kind, value) in store.fielddefs[name][1]:
        values[field] = _value(store, kind, value, numbers)
    return store.types[name](**values)


def _value(store: Any, kind: Nodetype, value: Any, numbers: Iterator[int]) -> Any:
    if kind == Nodetype.NAME:
        return filled(store, value, numbers)
    if kind == Nodetype.BASE:
        if value[0] == "string":
            return f"text {next(numbers)}"
        return bool(next(numbers) % 2) if value[0] == "bool" else next(numbers) % 100
    (inner, base), size = value
    length = size if kind == Nodetype.ARRAY else 2
    several = [_value(store, inner, base, numbers) for _ in range(length)]
    if inner == Nodetype.BASE and base[0] != "string":
        dtype = {"byte": "uint8", "char": "uint8", "octet": "uint8"}.get(base[0], base[0])
        return np.array(several, dtype)
    return several
