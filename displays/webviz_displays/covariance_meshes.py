"""Covariances as translucent meshes, one for each colour."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from webviz import Mesh, Rgb
from webviz_displays.covariance import (
    Covariances,
    Placed,
    ellipses,
    ellipsoids,
    tip_discs,
    wedges,
)
from webviz_displays.pose_properties import OrientationCovariance, PositionCovariance
from webviz_displays.shapes import DISC, SPHERE, WEDGE, Shape, copies

F64 = NDArray[np.float64]

_RED, _GREEN, _BLUE = (255, 0, 0), (0, 255, 0), (0, 0, 255)


def position_mesh(
    look: PositionCovariance, given: Covariances, positions: F64, frames: F64
) -> Mesh:
    """Ellipses and ellipsoids around N positions.

    Args:
        look: properties.
        given: in the axes of `frames`.
        positions: (N, 3), metres.
        frames: (N, 3, 3), rotations.
    """
    parts = (
        (DISC, ellipses(given, positions, frames, look.scale)),
        (SPHERE, ellipsoids(given, positions, frames, look.scale)),
    )
    return _mesh(parts, look.color, look.alpha)


def orientation_meshes(
    look: OrientationCovariance, given: Covariances, positions: F64, axes: F64
) -> dict[str, Mesh]:
    """Wedges and discs at N poses, by key.

    Args:
        look: properties.
        given: covariances of rotations about `axes`.
        positions: (N, 3), metres.
        axes: (N, 3, 3), rotations.
    """
    scale, offset = look.scale, look.offset
    # As in RViz each disc has the colour of the axis whose tip it surrounds; yaw alone is blue.
    x, y, z = ((DISC, tip_discs(given, positions, axes, scale, offset, axis)) for axis in (0, 1, 2))
    yaw = (WEDGE, wedges(given, positions, axes, scale, offset))
    if look.color_style == "Unique":
        return {"orientation": _mesh((x, y, z, yaw), look.color, look.alpha)}
    return {
        "orientation x": _mesh((x,), _RED, look.alpha),
        "orientation y": _mesh((y,), _GREEN, look.alpha),
        "orientation z": _mesh((z, yaw), _BLUE, look.alpha),
    }


def _mesh(parts: Iterable[tuple[Shape, Placed]], color: Rgb, alpha: float) -> Mesh:
    vertices, faces, count = [], [], 0
    for shape, placed in parts:
        corners, triangles = copies(shape, *placed)
        vertices.append(corners)
        faces.append(triangles + np.uint32(count))
        count += len(corners)
    return Mesh(np.concatenate(vertices), np.concatenate(faces), color, alpha)
