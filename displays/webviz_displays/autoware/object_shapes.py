"""Lines of Autoware's objects in their own frames: x ahead, z up, the origin at the centre."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from webviz_displays.shared.geometry import LONGEST

F64 = NDArray[np.float64]

BOX, CYLINDER, POLYGON = range(3)
"""`type` of an autoware_perception_msgs/msg/Shape."""
SIDES = 20
"""Number of sides of circles."""
STEP = math.radians(10.0)
"""Largest angle between points of an arc."""
ARROWHEAD = 0.5
"""Length of the sides of an arrowhead, metres."""
MIN_WIDTH, WIDTH_SHARE = 0.1, 0.05
"""Length of the bars at the ends of an interval of angles: metres at least, and of its radius."""


def outline(kind: int, size: F64, footprint: F64, is_flat: bool) -> F64:
    """Return the edges (M, 2, 3) of a shape.

    Args:
        kind: of the shape; others count as polygons.
        size: (3,), metres.
        footprint: (N, 2), corners of a polygon.
        is_flat: draw the base only.
    """
    x, y, z = size / 2
    if kind == BOX:
        ring = np.array(((x, y), (x, -y), (-x, -y), (-x, y)))
        pillars = ring
    elif kind == CYLINDER:
        ring = _circle(x, SIDES)
        pillars = _circle(x, 4)
    else:
        ring = pillars = footprint
    base = _closed(ring, -z)
    if is_flat:
        return base
    upright = np.stack((_at(pillars, z), _at(pillars, -z)), axis=1)
    return np.concatenate((_closed(ring, z), base, upright))


def heading(size: F64, is_known: bool, is_flat: bool) -> F64:
    """Return the marks (M, 2, 3) of a box's front: a triangle, or ticks if it may be the back."""
    x, y, z = size / 2
    top = -z if is_flat else z
    if not is_known:
        tick = y / 2
        back = x - min(tick, x)
        ends = (((x, y - tick), (back, y)), ((x, -y + tick), (back, -y)))
        return _at(np.array(ends).reshape(-1, 2), top).reshape(-1, 2, 3)
    back = x - min(1.4 * y, size[0])
    triangle = _closed(np.array(((x, 0.0), (back, y), (back, -y))), top)
    if is_flat:
        return triangle
    braces = (((x, 0.0, -z), (x, y, z)), ((x, 0.0, -z), (x, -y, z)))
    return np.concatenate((triangle, np.array(braces)))


def sector(start: float, end: float, radius: float) -> F64:
    """Return the edges (M, 2, 3) of a sector between two angles in radians."""
    count = max(3, int(abs(end - start) / STEP))
    angles = np.linspace(start, end, count)
    arc = radius * np.column_stack((np.cos(angles), np.sin(angles), np.zeros(count)))
    points = np.concatenate((np.zeros((1, 3)), arc, np.zeros((1, 3))))
    return np.stack((points[:-1], points[1:]), axis=1)


def interval(middle: float, half: float, radius: float) -> F64:
    """Return the lines (M, 2, 3) of an interval of angles in rad: two chords, bars at its ends."""
    bar = max(WIDTH_SHARE * radius / 0.8, MIN_WIDTH)
    low, high = middle - half, middle + half
    return np.array(
        [
            (_polar(radius, middle), _polar(radius, high)),
            (_polar(radius, middle), _polar(radius, low)),
            (_polar(radius + bar, high), _polar(radius - bar, high)),
            (_polar(radius + bar, low), _polar(radius - bar, low)),
        ]
    )


def arrowheads(points: F64, yaws: F64) -> F64:
    """Triangles (3 N, 2, 3) at points (N, 3), whose tips look along `yaws` (N,) in radians."""
    opening = math.pi * 5.5 / 6.0
    sides = [
        points + ARROWHEAD * np.column_stack((np.cos(a), np.sin(a), np.zeros(len(a))))
        for a in (yaws + opening, yaws - opening)
    ]
    corners = np.stack((points, *sides), axis=1)
    return np.stack((corners, np.roll(corners, -1, axis=1)), axis=2).reshape(-1, 2, 3)


def ellipse(matrix: ArrayLike) -> tuple[float, float, float] | None:
    """Return standard deviations along the axes of a covariance (2, 2), and the angle of the first.

    Returns:
        None if it is not a covariance.
    """
    matrix = np.asarray(matrix, np.float64)
    if not (np.abs(matrix) < LONGEST**2).all():
        return None
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    if values[0] < -1e-9 * max(values[1], 1.0):
        return None
    first, second = np.sqrt(np.maximum(values, 0.0)).tolist()
    return first, second, math.atan2(vectors[1, 0], vectors[0, 0])


def _circle(radius: float, count: int) -> F64:
    angles = math.pi / count + 2 * math.pi * np.arange(count) / count
    return radius * np.column_stack((np.cos(angles), np.sin(angles)))


def _at(ring: F64, z: float) -> F64:
    return np.column_stack((ring, np.full(len(ring), z)))


def _closed(ring: F64, z: float) -> F64:
    points = _at(ring, z)
    return np.stack((points, np.roll(points, -1, axis=0)), axis=1)


def _polar(radius: float, angle: float) -> tuple[float, float, float]:
    return radius * math.cos(angle), radius * math.sin(angle), 0.0
