"""The panels of .rviz files; the list is kept whole, so that unsupported ones stay in place."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.declared import make, to_values
from webviz.api.panel import Panel
from webviz.api.registry import plugin_types
from webviz.files.config import PanelItem, all_panels
from webviz.files.rviz import values
from webviz.files.rviz.classes import counterpart
from webviz.files.rviz.displays import is_writable
from webviz.files.rviz.properties import keys
from webviz.files.rviz.report import Report
from webviz.files.rviz.structs import Reading, struct_tree
from webviz.files.rviz.tree import Tree


def read_panels(entries: Any, tools: Any, report: Report) -> list[PanelItem]:
    """Return the panels that every config has, and those in RViz's list that are plug-ins here.

    Args:
        entries: RViz's list.
        tools: of the same file; those that do what a panel does open it.
        report: receives invalid values.
    """
    found: list[PanelItem] = all_panels()
    for entry in entries if isinstance(entries, list) else []:
        cls = _counterpart(entry)
        if cls is None or not cls.on_request or any(type(each) is cls for each in found):
            continue
        reading = Reading()
        found.append(make(cls, reading.struct(cls, entry)))
        for path, reason in reading.faults:
            report.count("properties", 0, 1)
            report.note(values.text(entry.get("Name", "?")), "/".join(path), reason)
    for cls in _of_tools(tools):
        if not any(type(each) is cls for each in found):
            found.append(make(cls, {}))
    return found


def _of_tools(tools: Any) -> list[type[Panel]]:
    """Return the panels that do what tools of RViz's list do."""
    entries = tools if isinstance(tools, list) else []
    names = {values.text(each.get("Class")) for each in entries if isinstance(each, Mapping)}
    return [cls for cls in plugin_types(Panel).values() if cls.rviz_tool in names]


def write_panels(
    panels: list[PanelItem], kept: Any, tools: Any, report: Report
) -> list[Any] | None:
    """Panels as RViz's list, None if it is empty.

    Args:
        panels: of a config; those that every config has are not written.
        kept: the list of the file that they come from.
        tools: of that file; panels that it has as tools are not written, unless they were changed.
        report: receives those that RViz does not have.
    """
    everywhere = {type(each) for each in all_panels()}
    waiting = [
        panel for panel in panels if type(panel) not in everywhere and is_writable(panel, report)
    ]
    by_class = {type(panel): panel for panel in waiting}
    written: list[Any] = []
    for entry in kept if isinstance(kept, list) else []:
        cls = _counterpart(entry)
        if cls is None or not cls.on_request:
            written.append(entry)
        elif panel := by_class.get(cls):
            written.append({k: v for k, v in entry.items() if k not in keys(cls)} | _changed(panel))
            waiting = [each for each in waiting if each is not panel]
    as_tools = _of_tools(tools)
    for panel in waiting:
        if type(panel) in as_tools and not _changed(panel):
            continue
        written.append({"Class": type(panel).rviz, "Name": panel.name} | _changed(panel))
    return written or None


def _counterpart(entry: Any) -> type[Panel] | None:
    cls = entry.get("Class") if isinstance(entry, Mapping) else None
    return counterpart(Panel, values.text(cls))


def _changed(panel: Panel) -> Tree:
    """Return the properties of a panel, if some are not at their defaults."""
    return struct_tree(panel) if to_values(panel).keys() - {"name"} else {}
