"""Rotations and poses of many things at once.

Quaternions are arrays (..., 4) with w first, as nodes have them; ROS messages have w last.
"""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from webviz import Pose

F64 = NDArray[np.float64]

FARTHEST = 1e9
"""Metres; farther points are not measurements, and their squares overflow a GPU's float32."""


def w_first(xyzw: ArrayLike) -> F64:
    """Quaternions as ROS sends them (..., 4), in the order of nodes."""
    return np.roll(np.asarray(xyzw, dtype=np.float64), 1, axis=-1)


def normalized(quaternions: ArrayLike) -> tuple[F64, NDArray[np.bool_]]:
    """Quaternions (N, 4) of length one, and which rows (N,) could be normalised.

    A quaternion of length zero becomes the identity.
    """
    quaternions = np.asarray(quaternions, dtype=np.float64).reshape(-1, 4)
    scale = np.abs(quaternions).max(axis=1, keepdims=True, initial=0.0)
    ok = np.isfinite(scale[:, 0]) & (scale[:, 0] > 0.0)
    shrunk = np.where(ok[:, None], quaternions, (1.0, 0.0, 0.0, 0.0))
    shrunk = shrunk / np.where(
        ok[:, None], scale, 1.0
    )  # prevents squares from over- or underflowing
    return shrunk / np.linalg.norm(shrunk, axis=1, keepdims=True), ok


def matrices(wxyz: ArrayLike) -> F64:
    """Rotation matrices (..., 3, 3) of unit quaternions (..., 4)."""
    w, x, y, z = np.moveaxis(np.asarray(wxyz, dtype=np.float64), -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def multiply(a: ArrayLike, b: ArrayLike) -> F64:
    """Quaternion products a * b (..., 4): first the rotation `b`, then `a`."""
    aw, ax, ay, az = np.moveaxis(np.asarray(a, dtype=np.float64), -1, 0)
    bw, bx, by, bz = np.moveaxis(np.asarray(b, dtype=np.float64), -1, 0)
    return np.stack(
        (
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ),
        axis=-1,
    )


def conjugate(wxyz: ArrayLike) -> F64:
    """The inverse rotations of unit quaternions (..., 4)."""
    return np.asarray(wxyz, dtype=np.float64) * (1.0, -1.0, -1.0, -1.0)


def transformed(pose: Pose, xyz: ArrayLike) -> F64:
    """Points (N, 3) moved from the frame of `pose` to the frame it is given in."""
    return np.asarray(xyz, dtype=np.float64) @ matrices(pose.wxyz).T + pose.position


def coordinate(pose: Pose, xyz: NDArray[np.floating[Any]], axis: int) -> F64:
    """One coordinate of `transformed`, (N,), at one third of the cost."""
    row = matrices(pose.wxyz)[axis]
    columns = [xyz[:, i] * row[i].astype(xyz.dtype) for i in np.flatnonzero(row)]
    return np.add(functools.reduce(np.add, columns), pose.position[axis], dtype=np.float64)


def is_drawable(xyz: ArrayLike) -> NDArray[np.bool_]:
    """Which points (N, 3) have finite coordinates that a screen can show."""
    return np.all(np.abs(np.asarray(xyz, dtype=np.float64)) < FARTHEST, axis=-1)


def origin_near(xyz: ArrayLike) -> tuple[float, float, float]:
    """A round point within 1 km of the last of `xyz` (N, 3); zero where that is near zero.

    Nodes are float32, which resolves 0.5 m at UTM coordinates. Drawn relative to this point, in a
    group with this offset, they keep 0.1 mm. It is round so that it stays while data moves.
    """
    x, y, z = (np.round(np.asarray(xyz, dtype=np.float64)[-1] / 1000.0) * 1000.0).tolist()
    return x, y, z
