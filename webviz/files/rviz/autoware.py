"""Properties of Autoware's objects in files from before its plug-in grouped them."""

from __future__ import annotations

from collections.abc import Mapping

from webviz.files.rviz import values
from webviz.files.rviz.tree import Path, Tree, child, put

GROUPED: Mapping[str, Path] = {
    "Display Label": ("Text", "Label"),
    "Display UUID": ("Text", "UUID"),
    "Display Velocity": ("Text", "Velocity"),
    "Display Acceleration": ("Text", "Acceleration"),
    "Display Existence Probability": ("Text", "Existence Probability"),
    "Display Twist": ("Vector", "Twist"),
    "Display Yaw Rate": ("Vector", "Yaw Rate"),
    "Display Pose Covariance": ("Covariance", "Pose"),
    "Display Yaw Covariance": ("Covariance", "Yaw"),
    "Display Twist Covariance": ("Covariance", "Twist"),
    "Display Yaw Rate Covariance": ("Covariance", "Yaw Rate"),
    "Confidence Interval": ("Covariance", "Confidence Interval"),
    "Display Predicted Paths": ("Path", "Predicted Path"),
    "Display Predicted Path Confidence": ("Path", "Path Confidence"),
    "Visualization Type": ("Path", "Path Resolution"),
}
"""New places of values, by their former key."""
CLASSES, COLORS = (
    (
        *("UNKNOWN", "CAR", "TRUCK", "BUS", "TRAILER", "MOTORCYCLE", "CYCLIST", "PEDESTRIAN"),
        *("ANIMAL", "HAZARD"),
    ),
    "Per Class Color",
)
"""Groups of before with a colour and an opacity for each class, and the group of colours now."""
POLYGONS, FILLING = "Polygon Type", "Object Fill Type"
SHAPES = {"2d": "Skeleton 2D", "disable": "None"}
"""New shapes by the former polygon type."""


def grouped(tree: Tree) -> Tree:
    """Return a display of objects with the keys of now, which count if both are there.

    Args:
        tree: of the file, not changed.
    """
    moved = {key: tree[key] for key in GROUPED if key in tree}
    classes = {name: child(tree, name) for name in CLASSES if isinstance(tree.get(name), Mapping)}
    moved_keys = {*moved, *classes, POLYGONS, FILLING}
    result = {
        key: dict(value) if isinstance(value, Mapping) else value
        for key, value in tree.items()
        if key not in moved_keys
    }
    for key, value in moved.items():
        _put_new(result, GROUPED[key], value)
    if POLYGONS in tree or FILLING in tree:
        kind, fill = (_word(tree.get(key)) for key in (POLYGONS, FILLING))
        filled = "Fill" if fill == "fill" else "Skeleton 3D"
        _put_new(result, ("Shape", "Shape Type"), SHAPES.get(kind, filled))
    if classes and COLORS not in result:
        colors = {name: each["Color"] for name, each in classes.items() if "Color" in each}
        result[COLORS] = {"Value": True, **colors}
        alphas = [each["Alpha"] for each in classes.values() if "Alpha" in each]
        if alphas:
            result.setdefault("Alpha", alphas[0])
    return result


def _put_new(tree: Tree, path: Path, value: object) -> None:
    group, name = path
    if name not in child(tree, group):
        put(tree, path, value)


def _word(raw: object) -> str:
    return values.text(values.own_value(raw)).lower()
