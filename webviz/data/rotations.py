"""Rotations as unit quaternions, one or many at a time.

Here and in nodes they have w first; in ROS messages and `webviz.transforms` they have w last. One
is a tuple of floats, many are float64 arrays (..., 4). The transform buffer has its own formulas in
`transforms/geometry.py`, which agree with tf2 to the last bit.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]
F64 = NDArray[np.float64]

_W_FIRST = np.array((3, 0, 1, 2))


def multiply(a: Any, b: Any) -> Quaternion:
    """Return the rotation `b` followed by the rotation `a`: the Hamilton product."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def multiply_many(a: ArrayLike, b: ArrayLike) -> F64:
    """Return the rotations `b` (..., 4), each followed by the rotation `a`; they broadcast."""
    return np.stack(multiply(_components(a), _components(b)), axis=-1)


def from_axis_angle(axis: Vector, angle: float) -> Quaternion:
    """Return the rotation by `angle` rad about the unit vector `axis`.

    The identity for a zero axis.
    """
    if not any(axis):
        return 1.0, 0.0, 0.0, 0.0
    s = math.sin(angle / 2.0)
    return math.cos(angle / 2.0), s * axis[0], s * axis[1], s * axis[2]


def from_rpy(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Return the rotation that URDF's rpy means: in rad about the fixed axes x, then y, then z."""
    about_x = from_axis_angle((1.0, 0.0, 0.0), roll)
    about_y = from_axis_angle((0.0, 1.0, 0.0), pitch)
    about_z = from_axis_angle((0.0, 0.0, 1.0), yaw)
    return multiply(about_z, multiply(about_y, about_x))


def to_rpy(wxyz: Quaternion) -> Vector:
    """Roll, pitch and yaw of a unit quaternion, in rad; the reverse of `from_rpy`."""
    w, x, y, z = wxyz
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return roll, pitch, yaw


def angle_between(a: Quaternion, b: Quaternion) -> float:
    """Return the angle of the rotation from `a` to `b`, in [0, pi] rad.

    Neither need have length one.
    """
    w, x, y, z = b
    w, x, y, z = multiply((w, -x, -y, -z), a)
    return 2.0 * math.atan2(math.sqrt(x * x + y * y + z * z), abs(w))


def w_first(xyzw: ArrayLike) -> F64:
    """Quaternions (..., 4) converted from the order of ROS messages: x, y, z, w."""
    # `np.roll` takes five times as long for 200 of them.
    return np.asarray(xyzw, dtype=np.float64).take(_W_FIRST, axis=-1)


def w_last(wxyz: Quaternion) -> Quaternion:
    """Return a quaternion converted to the order of ROS messages: x, y, z, w."""
    w, x, y, z = wxyz
    return x, y, z, w


def normalized(quaternions: ArrayLike) -> tuple[F64, NDArray[np.bool_]]:
    """Quaternions (N, 4) of length one, and which rows (N,) could be normalised.

    A quaternion of length zero becomes the identity.
    """
    quaternions = np.asarray(quaternions, dtype=np.float64).reshape(-1, 4)
    scale = np.abs(quaternions).max(axis=1, keepdims=True, initial=0.0)
    ok = np.isfinite(scale[:, 0]) & (scale[:, 0] > 0.0)
    shrunk = np.where(ok[:, None], quaternions, (1.0, 0.0, 0.0, 0.0))
    shrunk = shrunk / np.where(ok[:, None], scale, 1.0)  # squares must not over- or underflow
    return shrunk / np.linalg.norm(shrunk, axis=1, keepdims=True), ok


def conjugate(wxyz: ArrayLike) -> F64:
    """Return the inverse rotations of unit quaternions (..., 4)."""
    return np.asarray(wxyz, dtype=np.float64) * (1.0, -1.0, -1.0, -1.0)


def matrices(wxyz: ArrayLike) -> F64:
    """Rotation matrices (..., 3, 3) of unit quaternions (..., 4)."""
    w, x, y, z = np.asarray(wxyz, dtype=np.float64).T
    columns = (
        (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.array(columns).T


def from_matrices(m: F64) -> F64:
    """Return unit quaternions (N, 4), of either sign, of rotation matrices (N, 3, 3).

    Each is the eigenvector to the largest eigenvalue of a symmetric matrix of the entries
    (I. Bar-Itzhack, "New method for extracting the quaternion from a rotation matrix", JGCD 23(6),
    2000).
    """
    lower = np.zeros((len(m), 4, 4))
    xx, yy, zz = m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]
    lower[:, 0, 0], lower[:, 1, 1] = xx + yy + zz, xx - yy - zz
    lower[:, 2, 2], lower[:, 3, 3] = yy - xx - zz, zz - xx - yy
    lower[:, 1, 0], lower[:, 2, 1] = m[:, 2, 1] - m[:, 1, 2], m[:, 1, 0] + m[:, 0, 1]
    lower[:, 2, 0], lower[:, 3, 1] = m[:, 0, 2] - m[:, 2, 0], m[:, 2, 0] + m[:, 0, 2]
    lower[:, 3, 0], lower[:, 3, 2] = m[:, 1, 0] - m[:, 0, 1], m[:, 2, 1] + m[:, 1, 2]
    return np.linalg.eigh(lower)[1][:, :, 3]


def _components(quaternions: ArrayLike) -> F64:
    return np.moveaxis(np.asarray(quaternions, dtype=np.float64), -1, 0)
