"""Reasons why markers cannot be drawn, or cannot be seen."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from webviz import Level
from webviz.data.messages.markers import NOTHING, Content, Marker, MarkerSequence
from webviz_displays.markers.batch import MarkerBatch
from webviz_displays.markers.triangles import corner_colors
from webviz_displays.shared.geometry import FARTHEST, is_drawable

TYPES = (
    "ARROW",
    "CUBE",
    "SPHERE",
    "CYLINDER",
    "LINE_STRIP",
    "LINE_LIST",
    "CUBE_LIST",
    "SPHERE_LIST",
    "POINTS",
    "TEXT_VIEW_FACING",
    "MESH_RESOURCE",
    "TRIANGLE_LIST",
    "ARROW_STRIP",
)
"""The names of the types, by their number."""

Fault = tuple[int, Level, str]
"""The row of a marker in its batch, and a sentence about it."""

_LINES = (Marker.LINE_STRIP, Marker.LINE_LIST)
_LISTS = (*_LINES, Marker.CUBE_LIST, Marker.SPHERE_LIST, Marker.POINTS, Marker.TRIANGLE_LIST)
_SHAPES = (Marker.CUBE, Marker.SPHERE, Marker.CYLINDER)
_HAS_CONTENT = ~np.isin(np.arange(len(TYPES)), _SHAPES)
"""Types that need more than a scale and a color to be visible."""


def type_name(type_: int) -> str:
    """Return the name of a type, or its number."""
    return TYPES[type_] if 0 <= type_ < len(TYPES) else f"type {type_}"


def is_valid(markers: MarkerSequence) -> NDArray[np.bool_]:
    """Return the mask of markers with finite numbers and drawable lengths."""
    with np.errstate(invalid="ignore"):
        ok = is_drawable(markers.positions) & is_drawable(markers.scales)
    ok &= np.isfinite(markers.orientations).all(axis=1) & np.isfinite(markers.colors).all(axis=1)
    for row, content in enumerate(markers.contents):
        if content is not NOTHING and ok[row]:
            ok[row] = _is_valid(content, markers.scales[row], int(markers.types[row]))
    return ok


def _is_valid(content: Content, scale: NDArray[np.float64], type_: int) -> bool:
    if len(content.points):
        with np.errstate(invalid="ignore", over="ignore"):
            factor = max(1.0, float(np.abs(scale).max())) if type_ == Marker.TRIANGLE_LIST else 1.0
            reach = max(float(content.points.max()), -float(content.points.min())) * factor
        if not reach < FARTHEST:  # NaN included
            return False
    if len(content.colors) and not np.isfinite(content.colors).all():
        return False
    return not len(content.uv_coordinates) or bool(np.isfinite(content.uv_coordinates).all())


def faults_of(batch: MarkerBatch) -> Iterator[Fault]:
    """Return why markers cannot be seen, one sentence for each that cannot."""
    types, scales, alphas = batch.types, batch.scales, batch.colors[:, 3]
    is_known = (types >= 0) & (types < len(TYPES))
    can_fail = (~is_known) | (alphas <= 0.0) | (scales == 0.0).any(axis=1)
    is_text = (types == Marker.TEXT_VIEW_FACING) & ~can_fail & (scales[:, 2] > 0.0)
    for row in np.flatnonzero(can_fail | _HAS_CONTENT[np.where(is_known, types, 0)]).tolist():
        content = batch.contents[row]
        if is_text[row] and content.text.strip():
            continue  # quickly, as there may be many
        color = batch.colors[row]
        keeps_materials = bool(batch.own_materials[row]) and not color.any()
        if fault := _fault(int(types[row]), content, scales[row].tolist(), color, keeps_materials):
            yield row, *fault


def _fault(
    type_: int,
    content: Content,
    scale: list[float],
    color: NDArray[np.float32],
    keeps_materials: bool,
) -> tuple[Level, str] | None:
    name = type_name(type_)
    count = len(content.points)
    if not 0 <= type_ < len(TYPES):
        return Level.ERROR, f"The type {type_} is unknown. Types are 0 (ARROW) to 12 (ARROW_STRIP)."
    if type_ in _LISTS and not count:
        return Level.WARN, f"The {name} has no points."
    if type_ == Marker.LINE_LIST and count % 2:
        return Level.ERROR, f"The LINE_LIST has {count} points; add one, since two make a line."
    if type_ == Marker.LINE_STRIP and count == 1:
        return Level.WARN, "The LINE_STRIP has only one point; a line needs two."
    if type_ == Marker.TRIANGLE_LIST and count % 3:
        return Level.ERROR, f"The TRIANGLE_LIST has {count} points; three make a triangle."
    if type_ == Marker.ARROW_STRIP and count < 2:
        return Level.ERROR, f"The ARROW_STRIP has {count} points; an arrow needs two."
    if type_ == Marker.ARROW and count == 1:
        return Level.ERROR, "The ARROW has only one point; set two, or none to use its pose."
    if type_ == Marker.TEXT_VIEW_FACING and not content.text.strip():
        return Level.WARN, "The text is empty."
    if type_ == Marker.MESH_RESOURCE and not content.mesh_resource:
        return Level.ERROR, "The MESH_RESOURCE names no mesh. Set mesh_resource."
    return _invisible(type_, content, scale, None if keeps_materials else color)


def _invisible(
    type_: int, content: Content, scale: list[float], color: NDArray[np.float32] | None
) -> tuple[Level, str] | None:
    """Return why a marker is not seen; without `color`, a mesh has the materials of its file."""
    if needed := _missing_scale(type_, len(content.points), scale):
        return Level.WARN, f"The scale is 0 in {needed}. Set it to the size in metres."
    if color is not None and _is_clear(type_, content, color):
        whose = "every color" if len(content.colors) else "the color"
        return Level.WARN, f"It is invisible: alpha of {whose} is 0. Set it to 1."
    return None


def _missing_scale(type_: int, points: int, scale: list[float]) -> str:
    if type_ in (*_LINES, Marker.POINTS):
        needed = "x"
    elif type_ == Marker.TEXT_VIEW_FACING:
        needed = "z"
    elif type_ == Marker.ARROW_STRIP or (type_ == Marker.ARROW and points == 2):
        return "x and y" if not scale[0] and not scale[1] else ""
    else:
        needed = "xyz"
    bad = [axis for axis in needed if scale["xyz".index(axis)] == 0.0]
    if not bad and needed in ("x", "z") and scale["xyz".index(needed)] < 0.0:
        bad = [needed]
    return " and ".join(bad) if len(bad) < 3 else "x, y and z"


def _is_clear(type_: int, content: Content, color: NDArray[np.float32]) -> bool:
    if color[3] > 0.0:
        each = corner_colors(content) if type_ == Marker.TRIANGLE_LIST else _colors(type_, content)
        return each is not None and not (each[:, 3] > 0.0).any()
    each = corner_colors(content) if type_ == Marker.TRIANGLE_LIST else _colors(type_, content)
    return each is None or not (each[:, 3] > 0.0).any()


def _colors(type_: int, content: Content) -> NDArray[np.float32] | None:
    is_each = type_ in _LISTS and len(content.colors) == len(content.points)
    return content.colors if is_each and len(content.colors) else None
