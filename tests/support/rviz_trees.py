"""Comparison of the YAML of .rviz files."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from ruamel.yaml import YAML

EMPTY = ("", "~", "null", [])
"""RViz writes empty lists as ~."""


def differences(before: Any, after: Any, path: str = "") -> Iterator[str]:
    """Paths of `before` that `after` has not, or not with this value; trees of `texts`.

    Scalars are the same if they are the same text, or numbers equal in single precision, which is
    what RViz keeps. Keys that only `after` has are no loss: RViz adds its defaults as well.
    """
    if isinstance(before, dict) and isinstance(after, dict):
        for key, value in before.items():
            if key in after:
                yield from differences(value, after[key], f"{path}/{key}")
            else:
                yield f"{path}/{key}"
    elif isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        for index, (a, b) in enumerate(zip(before, after, strict=True)):
            yield from differences(a, b, f"{path}[{index}]")
    elif not _is_same_scalar(before, after):
        yield path


def _is_same_scalar(a: Any, b: Any) -> bool:
    if a == b or (a in EMPTY and b in EMPTY):
        return True
    try:
        numbers = float(a), float(b)
    except (TypeError, ValueError):
        return False
    in_range = all(math.isfinite(x) and abs(x) < 1e38 for x in numbers)
    return in_range and bool(np.float32(numbers[0]) == np.float32(numbers[1]))


def texts(text: str) -> Any:
    """YAML with every scalar as the text it is, as RViz reads it."""
    return YAML(typ="base", pure=True).load(text)


def loaded(text: str) -> Any:
    """YAML with numbers and truth values, by a reader that is not the one under test."""
    return YAML(typ="safe", pure=True).load(text)
