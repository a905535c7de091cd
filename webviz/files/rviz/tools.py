"""The toolbar of .rviz files, and what is kept of it for writing it again.

The list is kept whole, so that tools without a counterpart stay in their places.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeGuard

import msgspec

from webviz.api.declared import make, to_values
from webviz.api.registry import type_name
from webviz.api.tool import Tool
from webviz.files.config import Location, ToolItem, Unreadable, all_tools
from webviz.files.rviz import values
from webviz.files.rviz.classes import counterpart
from webviz.files.rviz.displays import note_properties
from webviz.files.rviz.report import Report
from webviz.files.rviz.structs import Reading, struct_tree
from webviz.files.rviz.tree import Tree, restored

NEW_TOOLS: list[Tree] = [
    {"Class": f"rviz_default_plugins/{name}"}
    for name in (
        "Interact",
        "MoveCamera",
        "Select",
        "FocusCamera",
        "Measure",
        "SetInitialPose",
        "SetGoal",
        "PublishPoint",
    )
]
"""The toolbar of a file that was never RViz's."""


def read_tools(entries: Any, report: Report, place: Location) -> list[ToolItem]:
    """The tools of the list in a .rviz file, which is at `place`; without a list, all of them."""
    if not isinstance(entries, list):
        return all_tools()
    tools: list[ToolItem] = []
    for index, entry in enumerate(entries):
        if cls := _counterpart(entry):
            reading, tree = Reading(), dict(entry)
            tool = _tool_from(cls, tree, reading)
            note_properties(tool, tree, reading, report, place.at(index))
            tools.append(tool)
    return tools


def write_tools(tools: list[ToolItem], kept: Any, report: Report) -> list[Any] | None:
    """Tools as RViz's list of them.

    Args:
        tools: of the toolbar.
        kept: the list of the file that they come from; None if it has none.
        report: gets what is left out.

    Returns:
        The list; None for RViz's own tools.
    """
    waiting = [tool for tool in tools if _is_writable(tool, report)]
    if not isinstance(kept, list):
        if list(map(_bare, waiting)) == [_bare(t) for t in all_tools() if isinstance(t, Tool)]:
            return None
        kept = NEW_TOOLS
    written = []
    for entry in kept:
        cls = _counterpart(entry)
        if cls is None:
            written.append(entry)
        elif found := next((tool for tool in waiting if type(tool) is cls), None):
            waiting.remove(found)
            written.append(_write(found, entry))
    return written + [_bare(tool) for tool in waiting]


def _counterpart(entry: Any) -> type[Tool] | None:
    cls = entry.get("Class") if isinstance(entry, Mapping) else None
    return counterpart(Tool, values.text(cls))


def _tool_from(cls: type[Tool], tree: Tree, reading: Reading) -> Tool:
    """A tool from RViz's tree of its properties."""
    try:
        return make(cls, reading.struct(cls, tree))
    except msgspec.ValidationError as error:  # a plug-in's own rule besides bounds
        reading.faults.append(((), f"{error}; using the defaults"))
        return make(cls, {})


def _bare(tool: Tool) -> Tree:
    return {"Class": type(tool).rviz, **struct_tree(tool)}


def _write(tool: Tool, kept: Tree) -> Tree:
    """A tool with what was kept of its entry in the file."""

    def meaning(tree: Tree) -> dict[str, Any]:
        return _values(_tool_from(type(tool), tree, Reading()))

    return restored(_bare(tool), {**kept, "Class": type(tool).rviz}, _values(tool), meaning)


def _values(tool: Tool) -> dict[str, Any]:
    """What a .rviz file can say of a tool."""
    return {key: value for key, value in to_values(tool).items() if key != "name"}


def _is_writable(item: ToolItem, report: Report) -> TypeGuard[Tool]:
    if isinstance(item, Unreadable):
        report.note(item.name, "this tool", f"skipped: {item.reason.removesuffix('.')}")
        return False
    if not type(item).rviz:
        report.note(item.name, type_name(type(item)), "skipped, because RViz has no such tool")
        return False
    return True
