"""What a .rviz file says besides displays, views and options: panels, tools, the window."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.tool import Tool
from webviz.files.rviz import values
from webviz.files.rviz.classes import counterpart
from webviz.files.rviz.report import Report
from webviz.files.rviz.tree import Tree, child

SAME_HERE = {
    "Panels": ("Displays", "Views", "Time"),
    "Tools": ("MoveCamera",),
}
"""RViz's own that need no counterpart: these panels are tabs, and the mouse moves the camera."""

KEPT = "kept for export"
PUBLISHES = f"nothing is published from the page yet; {KEPT}"
SELECTS = f"nothing can be selected in the scene yet; {KEPT}"
WHY_NOT = {
    "Interact": f"there are no interactive markers yet; {KEPT}",
    "Select": SELECTS,
    "Selection": SELECTS,
    "FocusCamera": SELECTS,
    "Measure": SELECTS,
    "SetInitialPose": PUBLISHES,
    "PublishPoint": PUBLISHES,
    "Tool Properties": f"there are no tools with properties yet; {KEPT}",
}
"""Why RViz's own panels and tools have no counterpart, by name."""
FOREIGN = f"plug-ins of RViz do not run here; {KEPT}"

_PACKAGES = {"Panels": "rviz_common", "Tools": "rviz_default_plugins"}
_ROS_1 = "rviz"
_TF = "rviz_default_plugins/TF"


def note_rest(document: Tree, report: Report) -> None:
    """Report panels, tools and the transformer."""
    manager = document["Visualization Manager"]
    for kind, entries in (("Panels", document.get("Panels")), ("Tools", manager.get("Tools"))):
        for entry in entries if isinstance(entries, list) else []:
            cls = values.text(entry.get("Class", "?")) if isinstance(entry, Mapping) else "?"
            reason = why_not(kind, cls)
            report.count(kind.lower(), reason is None, 1)
            if reason:
                name = cls.removeprefix("rviz_common/").removeprefix("rviz_default_plugins/")
                report.note("Panels and tools", name, f"unsupported; {KEPT}")
    transformer: Any = child(manager, "Transformation", "Current").get("Class", _TF)
    if transformer != _TF:
        report.note("Transformation", values.text(transformer), f"unsupported, tf2 is used; {KEPT}")


def why_not(kind: str, cls: str) -> str | None:
    """Why a class of "Panels" or "Tools" has no counterpart; None if it has one."""
    if kind == "Tools" and counterpart(Tool, cls):
        return None
    package, _, name = cls.partition("/")
    if package not in (_PACKAGES[kind], _ROS_1):
        return FOREIGN
    return None if name in SAME_HERE[kind] else WHY_NOT.get(name, f"it is not here yet; {KEPT}")
