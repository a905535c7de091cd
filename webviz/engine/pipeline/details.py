"""Details of a selected item, as a tree of texts."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from webviz.api.nodes import Pose
from webviz.api.picking import Quantity
from webviz.data.messages import to_tree
from webviz.data.messages.tree import Tree
from webviz.data.rotations import to_rpy

MAX_VALUES = 200
"""Values of one thing, nested ones included."""
MAX_TEXT = 400
"""Characters of one value."""


def details_tree(values: Mapping[str, object]) -> dict[str, Any]:
    """Values by name as a tree like those of `to_tree`, whose leaves are texts."""
    return _Maker().fields(values)


def first_line(values: Mapping[str, object]) -> str:
    """Return the first value with its name, "" if it is nothing that fits a line."""
    for name, value in values.items():
        text = _Maker().tree(value)
        return f"{name} {text}" if isinstance(text, str) else ""
    return ""


class _Maker:
    """Makes one tree."""

    def __init__(self) -> None:
        self._rest = MAX_VALUES

    def fields(self, values: Mapping[str, object]) -> dict[str, Any]:
        branches: dict[str, Tree] = {}
        for name, value in values.items():
            if self._rest <= 0:
                branches["…"] = "more than is shown here"
                break
            self._rest -= 1
            branches[str(name)[:MAX_TEXT]] = self.tree(value)
        return {"fields": branches}

    def tree(self, value: object) -> Tree:
        match value:
            case str():
                return value if len(value) <= MAX_TEXT else f"{value[:MAX_TEXT]}…"
            case Mapping():
                return self.fields(value)
            case Pose():
                return self.fields(_of_pose(value))
            case Quantity():
                return f"{self.tree(value.value)} {value.unit}"
            case np.ndarray() if value.ndim == 1 and len(value) <= MAX_VALUES:
                return spaced(value)
            case tuple() | list() if all(isinstance(each, float | int) for each in value):
                return spaced(value)
            case np.generic():
                return str(value)  # the shortest text that identifies a float32
            case _:
                return to_tree(value, self._rest)


def spaced(numbers: Iterable[Any]) -> str:
    """Numbers in a line."""
    return ", ".join(str(n) if isinstance(n, np.generic) else f"{n:.9g}" for n in numbers)


def _of_pose(pose: Pose) -> dict[str, str]:
    w, x, y, z = pose.wxyz
    roll, pitch, yaw = map(math.degrees, to_rpy(pose.wxyz))
    return {
        "Position": f"{_decimals(pose.position, 4)} m",
        "Orientation": f"x {x:.4f}, y {y:.4f}, z {z:.4f}, w {w:.4f}",
        "Roll, pitch, yaw": f"{_decimals((roll, pitch, yaw), 2)} °",
    }


def _decimals(values: Iterable[float], digits: int) -> str:
    return ", ".join(f"{round(value, digits) + 0.0:.{digits}f}" for value in values)
