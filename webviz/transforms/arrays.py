"""The formulas of `geometry` for many poses at once: arrays of shape (7, N), float64."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import starmap
from struct import Struct

import numpy as np
from numpy.typing import NDArray

from webviz.transforms.geometry import IDENTITY, Pose

F64 = NDArray[np.float64]

_POSE = Struct("7d")
_IDENTITY = np.reshape(IDENTITY, (7, 1))
_CONJUGATE = np.array([[0.0]] * 3 + [[-1.0]] * 3 + [[1.0]])
_NEGATED = np.array([[-1.0]] * 3 + [[0.0]] * 4)


def poses_to_rows(poses: Sequence[Pose]) -> F64:
    """Poses as an array (7, N)."""
    packed = b"".join(starmap(_POSE.pack, poses))
    return np.frombuffer(packed, np.float64).reshape(-1, 7).T.copy()


def canonical_many(rotations: F64) -> F64:
    """tf2's way through a matrix, as `geometry.canonical`.

    What comes out is the quaternion divided by its length, in the sign that makes w positive where
    the trace of the matrix is, and elsewhere the component of its largest diagonal element.

    Args:
        rotations: (4, N), quaternions (x, y, z, w) of any length but zero.

    Returns:
        (4, N).
    """
    x, y, z, w = rotations
    length2 = x * x + y * y + z * z + w * w
    s = 2.0 / length2
    xx, yy, zz = x * (x * s), y * (y * s), z * (z * s)
    m00, m11, m22 = 1.0 - (yy + zz), 1.0 - (xx + zz), 1.0 - (xx + yy)
    positive = w
    turned = ~(m00 + m11 + m22 > 0.0)
    if turned.any():
        largest = np.where(m00 < m11, np.where(m11 < m22, z, y), np.where(m00 < m22, z, x))
        positive = np.where(turned, largest, w)
    return rotations * (np.copysign(1.0, positive) / np.sqrt(length2))


def interpolation_table(start: F64, end: F64) -> F64:
    """What `interpolate_many` needs to know of each pair of poses.

    Args:
        start: (7, N) poses.
        end: (7, N) poses.

    Returns:
        (15, N): the start's translation and the way to the end's; both rotations, divided by the
        sine of the angle between them, the end's on the shorter way round; and that angle in
        quaternion space.
    """
    a, b = start[3:], end[3:]
    dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
    aa = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + a[3] * a[3]
    bb = b[0] * b[0] + b[1] * b[1] + b[2] * b[2] + b[3] * b[3]
    theta = np.arccos(np.minimum(np.abs(dot) / np.sqrt(aa * bb), 1.0))
    # Equal rotations: any small angle will do, as sin(r t) + sin((1 - r) t) is then sin(t).
    theta = np.maximum(theta, 1e-9)
    scale = 1.0 / np.sin(theta)
    rotations = (a * scale, b * np.copysign(scale, dot))
    return np.concatenate((start[:3], end[:3] - start[:3], *rotations, theta[None]))


def interpolate_many(table: F64, ratio: F64) -> F64:
    """`geometry.interpolate` within each pair of an `interpolation_table` (15, N).

    Returns:
        (7, N).
    """
    rest = 1.0 - ratio
    theta = table[14]
    out = np.empty((7, len(ratio)))
    np.add(table[:3], ratio * table[3:6], out=out[:3])
    start, end = np.sin(rest * theta), np.sin(ratio * theta)
    np.add(start * table[6:10], end * table[10:14], out=out[3:])
    return out


def compose_many(a: F64, b: F64) -> F64:
    """`geometry.compose`, each (7, N) or (7, 1), with fewer operations for unit quaternions."""
    ax, ay, az, x, y, z, w = a
    bx, by, bz, qx, qy, qz, qw = b
    out = np.empty((7, max(a.shape[1], b.shape[1])))
    # v + w t + u x t with t = 2 u x v, where u is the vector part of the quaternion.
    x2, y2, z2 = x + x, y + y, z + z
    tx, ty, tz = y2 * bz - z2 * by, z2 * bx - x2 * bz, x2 * by - y2 * bx
    out[0] = bx + w * tx + (y * tz - z * ty) + ax
    out[1] = by + w * ty + (z * tx - x * tz) + ay
    out[2] = bz + w * tz + (x * ty - y * tx) + az
    out[3] = w * qx + x * qw + y * qz - z * qy
    out[4] = w * qy + y * qw + z * qx - x * qz
    out[5] = w * qz + z * qw + x * qy - y * qx
    out[6] = w * qw - x * qx - y * qy - z * qz
    return out


def inverse_many(a: F64) -> F64:
    """`geometry.inverse` for poses (7, N)."""
    turn_back = a * _CONJUGATE
    move_back = a * _NEGATED + _IDENTITY
    return compose_many(turn_back, move_back)
