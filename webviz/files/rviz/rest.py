"""The other parts of a .rviz file: panels, tools, the window."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.tool import Tool
from webviz.files.rviz import values
from webviz.files.rviz.classes import counterpart
from webviz.files.rviz.report import Report
from webviz.files.rviz.tree import Tree, child

SAME_HERE = {"Panels": ("Displays", "Views", "Time"), "Tools": ("MoveCamera",)}
"""RViz's own that exist here: these panels are tabs, and the mouse moves the camera."""

KEPT = "kept for export"
PUBLISHES = f"publishing from the page is not supported yet; {KEPT}"
SELECTS = f"selecting in the scene is not supported yet; {KEPT}"
WHY_NOT = {
    "Interact": f"interactive markers are not supported yet; {KEPT}",
    "Select": SELECTS,
    "Selection": SELECTS,
    "FocusCamera": SELECTS,
    "Measure": SELECTS,
    "SetInitialPose": PUBLISHES,
    "PublishPoint": PUBLISHES,
    "Tool Properties": f"tools with properties are not supported yet; {KEPT}",
}
"""Why RViz's own panels and tools are unsupported, by name."""
FOREIGN = f"RViz plug-ins cannot run in webviz; {KEPT}"

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
        report.note("Transformation", values.text(transformer), f"unsupported, using tf2; {KEPT}")


def why_not(kind: str, cls: str) -> str | None:
    """Why a class of "Panels" or "Tools" is unsupported; None if it is supported."""
    if kind == "Tools" and counterpart(Tool, cls):
        return None
    package, _, name = cls.partition("/")
    if package not in (_PACKAGES[kind], _ROS_1):
        return FOREIGN
    return None if name in SAME_HERE[kind] else WHY_NOT.get(name, f"not supported yet; {KEPT}")
