"""The other parts of a .rviz file: panels, tools, the window."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.panel import Panel
from webviz.api.registry import plugin_types
from webviz.api.tool import Tool
from webviz.files.rviz import values
from webviz.files.rviz.classes import counterpart
from webviz.files.rviz.report import Report
from webviz.files.rviz.tree import MANAGER, Tree, child

SUPPORTED = {
    "Panels": [
        f"rviz_common/{name}"
        for name in (
            *("Displays", "Selection", "Views", "Time", "Tool Properties"),
            *("Transformation", "Help"),
        )
    ],
    "Tools": [
        f"rviz_default_plugins/{name}"
        for name in ("Interact", "MoveCamera", "Select", "FocusCamera", "Measure")
    ],
}
"""RViz's panels that are tabs here, and the tools that every page has."""

REASONS = {
    "nav2_rviz_plugins/Route Tool": "unsupported, because it edits files on RViz's computer",
    "rviz_plugins::SimulatedClockPanel": "unsupported, because it sets the time of the whole graph",
    "AutowareScreenCapturePanel": "unsupported; save pictures with `webviz screenshot`",
    "AutowareDateTimePanel": "unsupported; the time bar shows ROS time",
}
"""Reasons why panels are unsupported, and what to use instead, if there is more to say."""

FOR_EXPORT = "kept for export"

_TF = "rviz_default_plugins/TF"


def note_rest(document: Tree, report: Report) -> None:
    """Report panels, tools and the transformer."""
    for kind, entries in (
        ("Panels", document.get("Panels")),
        ("Tools", document[MANAGER].get("Tools")),
    ):
        for entry in entries if isinstance(entries, list) else []:
            cls = values.text(entry.get("Class", "?")) if isinstance(entry, Mapping) else "?"
            supported = is_supported(kind, cls)
            report.count(kind.lower(), supported, 1)
            if not supported:
                name = cls.removeprefix("rviz_common/").removeprefix("rviz_default_plugins/")
                report.note(
                    "Panels and tools", name, f"{REASONS.get(cls, 'unsupported')}; {FOR_EXPORT}"
                )
    transformer: Any = child(document, MANAGER, "Transformation", "Current").get("Class", _TF)
    if transformer != _TF:
        report.count("properties", 0, 1)
        report.note(
            "Transformation", values.text(transformer), f"unsupported, using tf2; {FOR_EXPORT}"
        )


def is_supported(kind: str, cls: str) -> bool:
    """Return whether a class of "Panels" or "Tools" is supported, also by its name in ROS 1."""
    if counterpart(Tool if kind == "Tools" else Panel, cls):
        return True
    if kind == "Tools" and any(cls == each.rviz_tool for each in plugin_types(Panel).values()):
        return True
    if kind == "Panels" and any(cls == tool.rviz_panel for tool in plugin_types(Tool).values()):
        return True
    return any(cls in (name, f"rviz/{name.partition('/')[2]}") for name in SUPPORTED[kind])
