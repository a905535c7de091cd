"""Unsupported values in .rviz files that change nothing in the scene."""

from __future__ import annotations

from typing import Any

from webviz.files.rviz.tree import Path, Tree

ALWAYS = {
    "Tree": "TF's tree of frames, which RViz rebuilds from the transforms",
    "Expand Tree": "how RViz's panel looks",
    "Expand Link Details": "how RViz's panel looks",
    "Expand Joint Details": "how RViz's panel looks",
    "Link Tree Style": "how RViz's panel looks",
}
"""Reasons by key, at any level of the path."""

AT_DEFAULT: dict[str, tuple[Any, ...]] = {
    "Selectable": (True,),
    "Position Transformer": ("XYZ", ""),
    "Near Clip Distance": (0.01, 0.009999999776482582),
    "Invert Z Axis": (False,),
    "Target Frame": ("<Fixed Frame>",),
}
"""By key: RViz's default values, which need no support."""

SCALARS = ("Temperature", "FluidPressure", "Illuminance", "RelativeHumidity")
HIDDEN_OF_SCALARS = (
    *("Position Transformer", "Color Transformer", "Channel Name", "Color", "Axis"),
    *("Autocompute Intensity Bounds", "Autocompute Value Bounds", "Use Fixed Frame"),
)
"""Properties of point clouds that RViz's displays of one number hide, but write."""


def is_without_effect(path: Path, tree: Tree) -> bool:
    """Whether the value at a path of a display has no effect on what RViz shows."""
    if any(key in ALWAYS for key in path):
        return True
    if path[0] in HIDDEN_OF_SCALARS and str(tree.get("Class")).rpartition("/")[2] in SCALARS:
        return True
    value: Any = tree
    for key in path:
        value = value.get(key) if isinstance(value, dict) else None
    return value == {} or any(value == each for each in AT_DEFAULT.get(path[-1], ()))
