"""The views of a .rviz file: the current one and the saved ones."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.properties import Property, properties_of
from webviz.api.views import FIXED_FRAME, VIEW_TYPES, Orbit, View, type_of
from webviz.files.rviz import values
from webviz.files.rviz.report import Report
from webviz.files.rviz.tree import Tree, is_same
from webviz.files.rviz.values import Unfit

PREFIX = "rviz_default_plugins/"
NEAR_CLIP_DISTANCE = 0.01
"""RViz's default; here the near plane follows from the distance."""

KEYS = {
    each.path: each.label.removesuffix(f" ({each.unit})")
    for cls in VIEW_TYPES.values()
    for each in properties_of(cls)
}
"""RViz's keys for the fields of views."""
UNUSED: Mapping[str, tuple[Any, str]] = {
    "Near Clip Distance": (NEAR_CLIP_DISTANCE, "the near plane follows from the distance"),
    "Enable Stereo Rendering": (False, "stereo is unsupported"),
    "Focal Shape Size": (0.05, "nothing marks the focal point"),
    "Focal Shape Fixed Size": (True, "nothing marks the focal point"),
}
"""RViz's default values of views, by their keys without a field, and why another value is not
used."""
AIDS = ("Focal Shape Size", "Focal Shape Fixed Size")
"""Keys of what RViz shows only while the view is turned; the scene is the same without it."""
BOUNDS = {
    "distance": (0.01, 1e6),
    "pitch": (-1.5698, 1.5698),
    "yaw": (-1e6, 1e6),
    "angle": (-1e6, 1e6),
    "scale": (1e-5, 1e6),
}
FARTHEST = 1e9


def kind_of(tree: Mapping[str, Any]) -> type[View] | None:
    """Return the type for RViz's view class, None if unsupported."""
    return VIEW_TYPES.get(values.text(tree.get("Class", PREFIX + "Orbit")).rpartition("/")[2])


def read(tree: Any, report: Report, place: str = "current view") -> View | None:
    """Return a view from RViz's tree, None if its type is unsupported.

    Args:
        tree: of the view.
        report: receives what is not carried over.
        place: names the view in the report.
    """
    tree = dict(tree) if isinstance(tree, Mapping) else {}
    cls = kind_of(tree)
    report.count("views", cls is not None, 1)
    if cls is None:
        reason = "unsupported view type, using the default; kept for export"
        report.note(place, values.text(tree["Class"]), reason)
        return None
    for key, (default, reason) in UNUSED.items():
        if key in tree and not is_same(values.own_value(tree[key]), default):
            report.note(place, key, f"{reason}; kept for export")
            report.count("properties", 0, int(key not in AIDS))
    fields = {
        field.path: _read_field(field, tree[KEYS[field.path]], report, place)
        for field in properties_of(cls)
        if KEYS[field.path] in tree
    }
    return cls(**fields)


def read_saved(trees: Any, report: Report) -> dict[str, View]:
    """Return the saved views by name; duplicates get a number."""
    views: dict[str, View] = {}
    for tree in trees if isinstance(trees, list) else []:
        if not isinstance(tree, Mapping):
            continue
        view = read(tree, report, f"saved view {_name(tree)}")
        if view is not None:
            views[free_name(_name(tree), views)] = view
    return views


def free_name(name: str, names: Mapping[str, Any]) -> str:
    """Return an unused name, with a number if necessary."""
    number, free = 1, name
    while free in names:
        number += 1
        free = f"{name} {number}"
    return free


def write(view: View, name: str = "Current View") -> Tree:
    """Return a view as RViz writes it."""
    tree: Tree = {
        "Class": PREFIX + type_of(view),
        "Name": name,
        "Value": f"{type_of(view)} (rviz_default_plugins)",
        "Near Clip Distance": NEAR_CLIP_DISTANCE,
    }
    for field in properties_of(type(view)):
        tree[KEYS[field.path]] = values.write(field.of(view), _kind(field))
    return tree


def read_current(tree: Any, report: Report) -> View:
    """Return the initial view of a file."""
    return read(tree, report) or Orbit()


def write_saved(saved: Mapping[str, View], originals: Any) -> list[Any] | None:
    """Return the list of saved views as RViz writes it.

    Args:
        saved: by name.
        originals: the list of the file they come from; unchanged views stay as they were there,
            and so do unsupported ones.

    Returns:
        None for an empty list, as RViz has it.
    """
    trees: list[Any] = []
    names: dict[str, None] = {}
    for tree in originals if isinstance(originals, list) else []:
        view = read(tree, Report()) if isinstance(tree, Mapping) else None
        if view is None:
            trees.append(tree)
            continue
        name = free_name(_name(tree), names)
        names[name] = None
        if name in saved and saved[name] == view:
            trees.append(tree)
        elif name in saved:
            trees.append({**write(saved[name], name), **_others(tree, saved[name])})
    trees += [write(view, name) for name, view in saved.items() if name not in names]
    return trees or None


def _name(tree: Mapping[str, Any]) -> str:
    return values.text(tree.get("Name") or "View")


def _others(tree: Mapping[str, Any], view: View) -> Tree:
    """Return the other keys of a tree, if it has the view's type."""
    if kind_of(tree) is not type(view):
        return {}
    return {key: value for key, value in tree.items() if key not in KEYS.values()}


def _read_field(field: Property, raw: Any, report: Report, place: str) -> Any:
    """Return the value of a field in RViz's tree, clamped to its bounds."""
    key = KEYS[field.path]
    try:
        value = values.read(raw, _kind(field))
    except Unfit as error:
        report.note(place, key, f"{error}; using the default")
        return field.default
    if field.path == "scale":
        value = abs(value)  # RViz flips the picture
    if isinstance(value, bool):
        return value
    if isinstance(value, str):
        return value or FIXED_FRAME
    if isinstance(value, tuple):
        return tuple(min(max(part, -FARTHEST), FARTHEST) for part in value)
    low, high = BOUNDS.get(field.path, (-FARTHEST, FARTHEST))
    return min(max(value, low), high)


def _kind(field: Property) -> Any:
    is_point = isinstance(field.default, tuple)
    return tuple[float, float, float] if is_point else field.hint
