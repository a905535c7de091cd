"""Displays and groups of .rviz files, and the parts kept for writing them back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeGuard

import msgspec

from webviz.api.declared import Declared, P, make, to_values
from webviz.api.display import Display
from webviz.api.group import DisplayGroup
from webviz.api.registry import type_name
from webviz.files.config import Branch, Item, Location, Unreadable, read_display
from webviz.files.rviz import topics, values
from webviz.files.rviz.classes import counterpart
from webviz.files.rviz.properties import keys, properties
from webviz.files.rviz.quiet import is_without_effect
from webviz.files.rviz.report import Report
from webviz.files.rviz.rest import FOR_EXPORT
from webviz.files.rviz.ros1 import modern
from webviz.files.rviz.structs import Reading, struct_tree
from webviz.files.rviz.tree import Path, Tree, difference, leaves, restored
from webviz.files.rviz.values import Unfit

NO_PROPERTIES = ("Class", "Name", "Enabled", "Value", "Displays")
NO_DISPLAY = f"unsupported display class; {FOR_EXPORT}"
NO_PROPERTY = f"unsupported; {FOR_EXPORT}"


class UnsupportedParts(msgspec.Struct):
    """The unsupported parts of a file's displays.

    Args:
        entries: class, name and the keys that writing the display does not restore, in order.
    """

    entries: list[Tree] = msgspec.field(default_factory=list)

    def take(self, cls: str, name: str) -> Tree:
        """Return the first entry of a class and name that is not taken yet, else an empty one."""
        for index, entry in enumerate(self.entries):
            if (entry.get("Class"), entry.get("Name")) == (cls, name):
                del self.entries[index]
                return {key: v for key, v in entry.items() if key not in ("Class", "Name")}
        return {}


def read_items(
    entries: list[Any], report: Report, unsupported: UnsupportedParts, place: Location
) -> list[Item]:
    """Return displays of the list at `place` in a .rviz file."""
    return [_read_item(entry, report, unsupported, place.at(i)) for i, entry in enumerate(entries)]


def _read_item(entry: Any, report: Report, unsupported: UnsupportedParts, place: Location) -> Item:
    tree = dict(entry) if isinstance(entry, Mapping) else {}
    name, cls = values.text(tree.get("Name", "")), values.text(tree.get("Class", ""))
    own_class = counterpart(Display, cls)
    report.count("displays", own_class is not None, 1)
    if own_class is None:
        report.note(name or _at_line("?", place), cls or "a display without class", NO_DISPLAY)
        report.count("properties", 0, len(_effective(tree)))
        return read_display({"type": cls or "?", "name": name or cls, "rviz": entry}, Location())
    display = _read(own_class, tree, name, report, place)
    if own_class.rviz != cls:
        report.note(name, cls, f"ROS 1's class, written as {own_class.rviz}")
    inner = tree.pop("Displays", []) if isinstance(display, DisplayGroup) else []
    written = bare(display)
    rest = difference({k: v for k, v in tree.items() if k not in ("Class", "Name")}, written)
    unsupported.entries.append({"Class": own_class.rviz, "Name": display.name, **rest})
    if not isinstance(display, DisplayGroup):
        return display
    entries = inner if isinstance(inner, list) else []
    return Branch(display, read_items(entries, report, unsupported, place.at("Displays")))


def _read(cls: type[Display], tree: Tree, name: str, report: Report, place: Location) -> Display:
    reading, tree = Reading(), modern(tree, keys(cls))
    display = display_from(cls, tree, reading)
    note_properties(display, tree, reading, report, place)
    return display


def note_properties(
    declared: Declared, tree: Tree, reading: Reading, report: Report, place: Location
) -> None:
    """Report the properties of a display or tool that were not read, or not as they are."""
    for path, reason in reading.faults:
        report.note(_at_line(declared.name, place.at(*path)), "/".join(path), reason)
    fault_paths = [path for path, _ in reading.faults]
    for path in _effective(tree):
        report.count("properties", path in reading.used, 1)
        if path not in reading.used and not any(path[: len(each)] == each for each in fault_paths):
            report.note(declared.name, "/".join(path), NO_PROPERTY)


def _at_line(name: str, place: Location) -> str:
    """Return a name with the line to correct."""
    return f"{name} (line {place.line})" if place.line else name


def _effective(tree: Tree) -> list[Path]:
    """Paths of the values of a display that affect what RViz shows."""
    properties = {key: value for key, value in tree.items() if key not in NO_PROPERTIES}
    return [path for path in leaves(properties) if not is_without_effect(path, tree)]


def display_from(cls: type[Display], tree: Tree, reading: Reading) -> Display:
    """Return a display from RViz's tree of its properties, as RViz would show it."""
    tree = modern(tree, keys(cls))
    plain = reading.struct(cls, tree)
    if tree.get("Class") != cls.rviz:  # ROS 1's class; some topics have other names
        plain = {key: value for key, value in plain.items() if value != {"name": ""}}
    plain |= {"name": values.text(tree.get("Name", "")), "enabled": _is_enabled(tree, reading)}
    return build(cls, plain, {"name": plain["name"], "enabled": plain["enabled"]}, reading)


def build(cls: type[P], plain: Tree, least: Tree, reading: Reading) -> P:
    """Return a display or tool from plain values, or `least` if they break a plug-in's own rule."""
    try:
        return make(cls, plain)
    except msgspec.ValidationError as error:
        reading.faults.append(((), f"{error}; using the defaults"))
        return make(cls, least)


def _is_enabled(tree: Tree, reading: Reading) -> bool:
    """RViz reads Enabled after Value; with neither a display is off."""
    for key in ("Enabled", "Value"):
        if key in tree:
            try:
                return values.read(tree[key], bool)
            except Unfit as error:
                reading.faults.append(((key,), f"{error}; using off"))
                return False
    return False


def bare(display: Display) -> Tree:
    """RViz's tree of a display, without kept parts of a file."""
    switch = {"Enabled": display.enabled, "Value": display.enabled}
    if isinstance(display, DisplayGroup):
        del switch["Value"]
    return {"Class": type(display).rviz, "Name": display.name, **switch, **struct_tree(display)}


def is_writable(item: P | Unreadable, report: Report) -> TypeGuard[P]:
    """Return whether RViz has a display or tool; otherwise the reason is reported."""
    if isinstance(item, Unreadable):
        report.note(item.name, "this entry", f"skipped: {item.reason.removesuffix('.')}")
        return False
    if not type(item).rviz:
        reason = f"skipped, because RViz has no such {type(item).kind}"
        report.note(item.name, type_name(type(item)), reason)
        return False
    return True


def write_items(
    items: list[Item], report: Report, unsupported: UnsupportedParts
) -> list[Any] | None:
    """Return displays as RViz's list, None if it is empty."""
    written = []
    for item in items:
        if isinstance(item, Branch):
            tree = _write(item.group, unsupported)
            written.append(tree | {"Displays": write_items(item.displays, report, unsupported)})
        elif isinstance(item, Unreadable) and item.is_from_rviz:
            written.append(item.values["rviz"])
        elif is_writable(item, report):
            written.append(_write(item, unsupported))
    return written or None


def _write(display: Display, unsupported: UnsupportedParts) -> Tree:
    cls = type(display)

    def meaning(tree: Tree) -> dict[str, Any]:
        return to_values(display_from(cls, tree, Reading()))

    kept_tree = unsupported.take(cls.rviz, display.name)
    tree = restored(bare(display), kept_tree, to_values(display), meaning)
    return topics.without_idle_marks(tree, properties(cls))
