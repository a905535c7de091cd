"""The arrows, rings and texts of controls without markers of their own.

Sizes are multiples of the scale of the interactive marker. The x axis of a control is what it moves
along or turns about, its y-z plane what it moves in.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from webviz.api.handles import Mode
from webviz.data.messages import Point, Pose, Quaternion, Vector3
from webviz.data.messages.markers import ColorRGBA, Marker
from webviz.data.rotations import matrices

ARROW = 0.5, 0.9
"""Distances of both ends of an arrow from the middle."""
ARROW_SIZE = 0.15, 0.25, 0.2
"""Diameters of its shaft and head, and the length of the head."""
RING = 0.5, 0.65
"""Inner and outer radius."""
RING_STEPS = 36
ALPHA = 0.5
DARK = 0.6
"""Shade of every other tooth of a ring."""
TEXT_HEIGHT = 0.25
TEXT_AT = -0.025, 0.0, 1.175

Wxyz = tuple[float, float, float, float]


def handles_of(mode: Mode, wxyz: Wxyz, scale: float, text: str) -> list[Marker]:
    """Return the handles that draw a control of a mode; empty for some modes.

    Args:
        wxyz: orientation of the control.
        scale: of the interactive marker.
        text: of a menu.
    """
    w, x, y, z = wxyz
    turned = Pose(orientation=Quaternion(x, y, z, w))
    color = _color(wxyz)
    if mode == "move_axis":
        return [
            Marker(
                type=Marker.ARROW,
                pose=turned,
                scale=Vector3(*(scale * size for size in ARROW_SIZE)),
                color=color,
                points=np.array([(sign * scale * at, 0.0, 0.0) for at in ARROW]),
            )
            for sign in (1.0, -1.0)
        ]
    if mode in ("move_plane", "rotate_axis", "move_rotate"):
        points, shades = _ring(mode)
        colors = np.column_stack(
            (shades[:, None] * (color.r, color.g, color.b), np.full(len(shades), ALPHA))
        )
        return [
            Marker(
                type=Marker.TRIANGLE_LIST,
                pose=turned,
                scale=Vector3(scale, scale, scale),
                color=color,
                points=points,
                colors=colors.astype(np.float32),
            )
        ]
    if mode == "menu" and text:
        size = TEXT_HEIGHT * scale
        return [
            Marker(
                type=Marker.TEXT_VIEW_FACING,
                pose=Pose(Point(*(scale * at for at in TEXT_AT))),
                scale=Vector3(size, size, size),
                color=ColorRGBA(1.0, 1.0, 1.0, 1.0),
                text=text,
            )
        ]
    return []


def _color(wxyz: Wxyz) -> ColorRGBA:
    """Return the direction of the x axis: red along x, green along y, blue along z."""
    axis = np.abs(matrices(wxyz)[:, 0])
    r, g, b = (axis / axis.max()).tolist()
    return ColorRGBA(r, g, b, ALPHA)


def _ring(mode: Mode) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the corners of a ring's triangles, (3 n, 3), and a shade for each of them, (n,)."""
    angle = np.arange(RING_STEPS) * (2.0 * np.pi / RING_STEPS)
    circle = np.column_stack((np.zeros(RING_STEPS), np.cos(angle), np.sin(angle)))
    inner, outer = RING[0] * circle, RING[1] * circle
    a, b, c = (np.roll(np.arange(RING_STEPS), -step) for step in range(3))
    if mode == "move_plane":
        triangles = (inner[a], outer[a], inner[b]), (inner[b], outer[a], outer[b])
    elif mode == "rotate_axis":  # teeth that point outwards, with others between them
        triangles = (inner[a], outer[b], inner[b]), (inner[b], outer[b], outer[c])
    else:  # teeth of two steps
        a, b, c = a[::2], b[::2], c[::2]
        teeth = (inner[a], outer[b], inner[b]), (inner[b], outer[b], inner[c])
        triangles = *teeth, (outer[a], outer[b], inner[a]), (outer[b], outer[c], inner[c])
    points = np.array(triangles).transpose(2, 0, 1, 3).reshape(-1, 3)
    shades = (1.0,) if mode == "move_plane" else (DARK, DARK, 1.0, 1.0)
    return points, np.resize(shades, len(points) // 3)
