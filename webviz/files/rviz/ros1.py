"""Properties that have another name, or another meaning, in files of ROS 1's RViz."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from webviz.files.rviz import autoware, values
from webviz.files.rviz.tree import Tree
from webviz.files.rviz.values import Unfit


def _variance(raw: Any) -> Any:
    """Return the square of a standard deviation."""
    try:
        return values.human(values.read(raw, float) ** 2)
    except Unfit:
        return raw


def _namespace(raw: Any) -> Any:
    """Return the namespace of interactive markers, given the topic of their updates."""
    return values.text(values.own_value(raw)).removesuffix("/update")


RENAMED: Mapping[str, tuple[str, Callable[[Any], Any]]] = {
    "Robot Description": ("Description Topic", values.own_value),
    "Update Topic": ("Interactive Markers Namespace", _namespace),
    "Use ColorMap": ("Use Rainbow", values.own_value),
    "Invert ColorMap": ("Invert Rainbow", values.own_value),
    "X std deviation": ("Covariance x", _variance),
    "Y std deviation": ("Covariance y", _variance),
    "Theta std deviation": ("Covariance yaw", _variance),
}
"""Keys of ROS 2, and what their values become, by the key of ROS 1."""


def modern(tree: Tree, keys: frozenset[str]) -> Tree:
    """Return a display or tool with the keys of ROS 2, which count if both are there.

    Args:
        tree: of the file.
        keys: of ROS 2 that the display or tool has.
    """
    renamed = {
        key: new
        for key, (new, _) in RENAMED.items()
        if key in tree and new in keys and key not in keys
    }
    result = {key: value for key, value in tree.items() if key not in renamed}
    for key, new in renamed.items():
        result.setdefault(new, RENAMED[key][1](tree[key]))
    return autoware.grouped(result) if autoware.COLORS in keys else result
