"""The toolbar of .rviz files; the list is kept whole, so that unsupported tools stay in place."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.declared import make, set_property, to_values
from webviz.api.tool import Tool
from webviz.files.config import Location, ToolItem, all_tools
from webviz.files.rviz import values
from webviz.files.rviz.classes import counterpart
from webviz.files.rviz.displays import build, is_writable, note_properties
from webviz.files.rviz.properties import keys
from webviz.files.rviz.report import Report
from webviz.files.rviz.ros1 import modern
from webviz.files.rviz.structs import Reading, struct_tree
from webviz.files.rviz.topics import TOPIC
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
"""The toolbar of a new file."""


def read_tools(entries: Any, panels: Any, report: Report, place: Location) -> list[ToolItem]:
    """Return the tools of the list at `place` in a .rviz file; without a list, all tools.

    Tools that RViz does not have are added, since no such list can name them; `panels` of the file
    may.
    """
    if not isinstance(entries, list):
        return [_with_topic(tool, panels) for tool in all_tools()]
    tools: list[ToolItem] = []
    for index, entry in enumerate(entries):
        if cls := _counterpart(entry):
            reading, tree = Reading(), modern(dict(entry), keys(cls))
            tool = _tool_from(cls, tree, reading)
            note_properties(tool, tree, reading, report, place.at(index))
            tools.append(tool)
    return [*tools, *(_with_topic(tool, panels) for tool in _all() if not type(tool).rviz)]


def write_tools(
    tools: list[ToolItem], originals: Any, panels: list[Any] | None, report: Report
) -> list[Any] | None:
    """Tools as RViz's list, None for RViz's own tools.

    Args:
        tools: of a config.
        originals: the list of the file that they come from.
        panels: of RViz's file; those that do what tools do here get their topics.
        report: receives skipped tools.
    """
    for tool in tools:
        if entry := _panel_of(tool, panels):
            entry[TOPIC] = getattr(tool, TOPIC.lower()).name
    waiting = [tool for tool in tools if not _is_added(tool, panels) and is_writable(tool, report)]
    if not isinstance(originals, list):
        if list(map(_bare, waiting)) == [_bare(tool) for tool in _all() if type(tool).rviz]:
            return None
        originals = NEW_TOOLS
    written = []
    for entry in originals:
        cls = _counterpart(entry)
        if cls is None:
            written.append(entry)
        elif matching := next((tool for tool in waiting if type(tool) is cls), None):
            waiting.remove(matching)
            written.append(_write(matching, entry))
    return written + [_bare(tool) for tool in waiting]


def _all() -> list[Tool]:
    return [tool for tool in all_tools() if isinstance(tool, Tool)]


def _is_added(tool: ToolItem, panels: Any) -> bool:
    """Return whether `read_tools` adds the tool as it is."""
    if not isinstance(tool, Tool) or type(tool).rviz:
        return False
    added = _with_topic(make(type(tool), {}), panels)
    return isinstance(added, Tool) and to_values(added) == to_values(tool)


def _with_topic(tool: ToolItem, panels: Any) -> ToolItem:
    """Return a tool with the topic of the panel that does the same in RViz, if there is one."""
    topic = (_panel_of(tool, panels) or {}).get(TOPIC)
    if topic and isinstance(topic, str) and isinstance(tool, Tool):
        set_property(tool, f"{TOPIC.lower()}.name", topic)
    return tool


def _panel_of(tool: ToolItem, panels: Any) -> Tree | None:
    """Return the entry of the panel that does the same as a tool."""
    cls = type(tool).rviz_panel if isinstance(tool, Tool) else ""
    entries = panels if cls and isinstance(panels, list) else []
    return next((e for e in entries if isinstance(e, dict) and e.get("Class") == cls), None)


def _counterpart(entry: Any) -> type[Tool] | None:
    cls = entry.get("Class") if isinstance(entry, Mapping) else None
    return counterpart(Tool, values.text(cls))


def _tool_from(cls: type[Tool], tree: Tree, reading: Reading) -> Tool:
    """Return a tool from RViz's tree of its properties."""
    return build(cls, reading.struct(cls, modern(tree, keys(cls))), {}, reading)


def _bare(tool: Tool) -> Tree:
    tree = struct_tree(tool)
    if tree.get("Confirm") is False:  # RViz never asks
        del tree["Confirm"]
    return {"Class": type(tool).rviz, **tree}


def _write(tool: Tool, original: Tree) -> Tree:
    """Return a tool with what was kept of its entry in the file."""

    def meaning(tree: Tree) -> dict[str, Any]:
        return _values(_tool_from(type(tool), tree, Reading()))

    return restored(_bare(tool), {**original, "Class": type(tool).rviz}, _values(tool), meaning)


def _values(tool: Tool) -> dict[str, Any]:
    """Return the properties of a tool that a .rviz file contains."""
    return {key: value for key, value in to_values(tool).items() if key != "name"}
