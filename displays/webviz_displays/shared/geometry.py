"""Coordinates of points, and whether they can be drawn."""

from __future__ import annotations

import functools
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from webviz import Pose, Prop
from webviz.data.rotations import matrices

F64 = NDArray[np.float64]

FARTHEST = 1e9
"""Metres; farther points are not measurements, and their squares overflow a GPU's float32."""

LONGEST = 1e6
"""Metres; larger sizes of arrows and other marks would overflow float32 with their scales."""

BOX_EDGES = np.array(
    [(i, (i + 1) % 4) for i in range(4)]
    + [(4 + i, 4 + (i + 1) % 4) for i in range(4)]
    + [(i, 4 + i) for i in range(4)]
)
"""(12, 2), of the corners of a box: those above, those below, and between them."""

Metres = Annotated[float, Prop(gt=0, unit="m")]
"""A size, for a `Prop` that says of what."""

Length = Annotated[Metres, Prop(le=LONGEST)]
"""The same of marks that grow with their scales."""


def transformed(pose: Pose, xyz: ArrayLike) -> F64:
    """Points (N, 3) moved from the frame of `pose` to the frame it is given in."""
    return np.asarray(xyz, dtype=np.float64) @ matrices(pose.wxyz).T + pose.position


def coordinate(
    pose: Pose, xyz: NDArray[np.floating[Any]], axis: int
) -> tuple[NDArray[np.floating[Any]], float]:
    """One coordinate of `transformed`, at a sixth of the cost.

    Returns:
        The coordinate relative to the position of the pose, (N,), as precise as `xyz`; and the
        coordinate of that position.
    """
    row = matrices(pose.wxyz)[axis]
    columns = [xyz[:, i] * row[i].astype(xyz.dtype) for i in np.flatnonzero(row)]
    return functools.reduce(np.add, columns), float(pose.position[axis])


def inverse(pose: Pose) -> Pose:
    """Return the pose of the frame that `pose` is given in, relative to it."""
    w, x, y, z = pose.wxyz
    px, py, pz = (-matrices(pose.wxyz).T @ pose.position).tolist()
    return Pose((px, py, pz), (w, -x, -y, -z))


def is_drawable(xyz: ArrayLike) -> NDArray[np.bool_]:
    """Return the mask of points (N, 3) with finite coordinates that a screen can show."""
    return np.all(np.abs(np.asarray(xyz, dtype=np.float64)) < FARTHEST, axis=-1)


def along_x(positions: F64, rotations: F64, length: float | F64) -> F64:
    """Arrows as RViz draws poses: tails and tips (N, 2, 3).

    Args:
        positions: (N, 3), metres.
        rotations: (N, 3, 3); the arrows point along their x axes.
        length: of shaft and head together, metres; (N, 1) or one for all.
    """
    return np.stack((positions, positions + length * rotations[..., 0]), axis=1)


def origin_near(xyz: ArrayLike) -> tuple[float, float, float]:
    """Return a round point within 1 km of the last of `xyz` (N, 3); zero where that is near zero.

    Nodes are float32, which resolves 0.5 m at UTM coordinates. Drawn relative to this point, in a
    group with this offset, they keep 0.1 mm. It is round so that it stays while data moves.
    """
    x, y, z = (np.round(np.asarray(xyz, dtype=np.float64)[-1] / 1000.0) * 1000.0).tolist()
    return x, y, z
