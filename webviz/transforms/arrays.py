"""The formulas of `geometry` for many poses at once: arrays of shape (7, N), float64."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]


def canonical_many(rotations: F64) -> F64:
    """tf2's way through a matrix, as `geometry.canonical`.

    Args:
        rotations: (4, N), quaternions (x, y, z, w) of any length but zero.

    Returns:
        (4, N), of unit length and of the sign that tf2 gives.
    """
    x, y, z, w = rotations
    s = 2.0 / (x * x + y * y + z * z + w * w)
    xs, ys, zs = x * s, y * s, z * s
    wx, wy, wz = w * xs, w * ys, w * zs
    xx, xy, xz = x * xs, x * ys, x * zs
    yy, yz, zz = y * ys, y * zs, z * zs
    diagonal = np.stack((1.0 - (yy + zz), 1.0 - (xx + zz), 1.0 - (xx + yy)))
    m00, m11, m22 = diagonal
    differences = ((yz + wx) - (yz - wx), (xz + wy) - (xz - wy), (xy + wz) - (xy - wz))
    trace = m00 + m11 + m22
    root = np.sqrt(np.maximum(trace, 0.0) + 1.0)
    s = 0.5 / root
    out = np.stack((*(d * s for d in differences), root * 0.5))
    turned = np.flatnonzero(~(trace > 0.0))
    if len(turned):
        largest = np.where(m00 < m11, np.where(m11 < m22, 2, 1), np.where(m00 < m22, 2, 0))
        sums = {(0, 1): xy, (0, 2): xz, (1, 2): yz}
        for i in range(3):
            n = turned[largest[turned] == i]
            if not len(n):
                continue
            j, k = (i + 1) % 3, (i + 2) % 3
            root = np.sqrt(diagonal[i, n] - diagonal[j, n] - diagonal[k, n] + 1.0)
            s = 0.5 / root
            out[i, n] = root * 0.5
            out[3, n] = differences[i][n] * s
            for other in (j, k):
                out[other, n] = 2.0 * sums[min(i, other), max(i, other)][n] * s
    return out


def slerp_weights(a: F64, b: F64) -> tuple[F64, F64, F64]:
    """What interpolation between rotations needs of each pair.

    Args:
        a: (4, N) unit quaternions.
        b: (4, N) unit quaternions.

    Returns:
        Per pair the angle theta in quaternion space, 1 / sin(theta), and the sign of `b` on the
        shorter way round; theta is 0 (and the second 1) where the rotations are equal.
    """
    dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
    aa = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + a[3] * a[3]
    bb = b[0] * b[0] + b[1] * b[1] + b[2] * b[2] + b[3] * b[3]
    theta = np.arccos(np.minimum(np.abs(dot) / np.sqrt(aa * bb), 1.0))
    scale = 1.0 / np.where(theta == 0.0, 1.0, np.sin(theta))
    return theta, scale, np.where(dot < 0.0, -1.0, 1.0)


def interpolate_many(
    a: F64, b: F64, ratio: F64, theta: F64, scale: F64, sign: F64
) -> tuple[Any, ...]:
    """`geometry.interpolate` from each `a` (7, N) to its `b`, with the weights of the pairs."""
    rest = 1.0 - ratio
    still = theta == 0.0
    wa = np.where(still, 1.0, np.sin(rest * theta) * scale)
    wb = np.sin(ratio * theta) * scale * sign
    return (
        *(rest * a[i] + ratio * b[i] for i in range(3)),
        *(a[i] * wa + b[i] * wb for i in range(3, 7)),
    )
