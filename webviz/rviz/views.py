"""The view of a .rviz file as the camera here."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from webviz.rviz import values
from webviz.rviz.report import Report
from webviz.rviz.tree import Tree
from webviz.rviz.values import Unfit
from webviz.views import View

ORBIT = "rviz_default_plugins/Orbit"
TOP_DOWN = "rviz_default_plugins/TopDownOrtho"
FPS = "rviz_default_plugins/FPS"
AROUND_A_POINT = ("Orbit", "XYOrbit", "ThirdPersonFollower")

HEIGHT_PX = 800
"""Of RViz's picture, to know how much of the world a scale in pixels per metre shows."""
FIELD_OF_VIEW = math.pi / 4
STEEPEST = 1.5698
MIN_DISTANCE, MAX_DISTANCE = 0.01, 1e6
PLACE = "current view"


def read(tree: Any, report: Report) -> View:
    """The camera that shows what a view of RViz shows, or nearly."""
    tree = dict(tree) if isinstance(tree, Mapping) else {}
    cls = values.text(tree.get("Class", ORBIT))
    kind = cls.rpartition("/")[2]
    report.count("views", kind == "Orbit", 1)
    if kind == "TopDownOrtho":
        reason = "there is no such view here yet, the camera looks down in perspective; it is kept"
        report.note(PLACE, cls, reason)
        return _from_above(tree, report)
    if kind not in AROUND_A_POINT:
        reason = "there is no such view here yet, the camera starts at its default; it is kept"
        report.note(PLACE, cls, reason)
        return View()
    if kind != "Orbit":
        report.note(PLACE, cls, "there is no such view here yet, Orbit is used; it is kept")
    if values.text(tree.get("Target Frame", "<Fixed Frame>")) != "<Fixed Frame>":
        reason = "the camera does not follow a frame yet; it is kept for export"
        report.note(PLACE, "Target Frame", reason)
    default = View()
    point = tree.get("Focal Point")
    axes = ("X", "Y", "Z") if isinstance(point, Mapping) else ()
    x, y, z = [_number(point, axis, 0.0, report) for axis in axes] or default.focal_point
    distance = _number(tree, "Distance", default.distance, report)
    pitch = _number(tree, "Pitch", default.pitch, report)
    return View(
        distance=min(max(distance, MIN_DISTANCE), MAX_DISTANCE),
        yaw=_number(tree, "Yaw", default.yaw, report),
        pitch=min(max(pitch, -STEEPEST), STEEPEST),
        focal_point=(x, y, z),
    )


def write(view: View) -> Tree:
    """A camera as RViz's Orbit view."""
    return {
        "Class": ORBIT,
        "Name": "Current View",
        "Value": "Orbit (rviz_default_plugins)",
        "Target Frame": "<Fixed Frame>",
        "Near Clip Distance": 0.01,
        "Distance": values.write(view.distance, float),
        "Yaw": values.write(view.yaw, float),
        "Pitch": values.write(view.pitch, float),
        "Focal Point": values.write(view.focal_point, tuple[float, float, float]),
    }


def _from_above(tree: Tree, report: Report) -> View:
    """The middle of the picture and how much of the world it shows stay.

    TopDownOrtho turns its camera by Angle about z, so that up is (-sin, cos) of it; up in an Orbit
    view from above is -(cos, sin) of its yaw.
    """
    scale = max(abs(_number(tree, "Scale", 10.0, report)), 1e-3)
    distance = HEIGHT_PX / scale / 2 / math.tan(FIELD_OF_VIEW / 2)
    x, y = _number(tree, "X", 0.0, report), _number(tree, "Y", 0.0, report)
    return View(
        distance=round(min(max(distance, MIN_DISTANCE), MAX_DISTANCE), 3),
        yaw=round(_number(tree, "Angle", 0.0, report) - math.pi / 2, 6),
        pitch=STEEPEST,
        focal_point=(x, y, 0.0),
    )


def _number(tree: Mapping[str, Any], key: str, default: float, report: Report) -> float:
    if key not in tree:
        return default
    try:
        return values.read(tree[key], float)
    except Unfit as error:
        report.note(PLACE, key, f"{error}; the default is used")
        return default
