"""Rigid transforms as tf2 computes them, operation by operation.

A pose is seven numbers `(x, y, z, qx, qy, qz, qw)`: it maps coordinates of a child frame into its
parent. The order of the floating point operations is tf2's own: the sign that the conversion from
matrix to quaternion gives to a rotation by 120 or 180 degrees depends on the last bit.
`rotate`, `compose` and `inverse` work elementwise: on floats and on the rows of a (7, N) array.
"""

from __future__ import annotations

from math import acos, nan, sin, sqrt
from struct import Struct
from typing import Any

PoseTuple = tuple[float, float, float, float, float, float, float]
Quaternion = tuple[float, float, float, float]
Matrix = tuple[float, float, float, float, float, float, float, float, float]

PACKED = Struct("7d")
"""A pose as bytes, in the order of this machine."""

IDENTITY: PoseTuple = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)

REACH_M = 1e12
"""Farthest that anything is drawn along an axis, some seven times the distance to the sun.

Finite transforms may compose to infinity or NaN, which no viewer can draw.
"""


def is_within_reach(pose: PoseTuple) -> bool:
    """Return whether a pose is finite and near enough to be drawn."""
    x, y, z, qx, qy, qz, qw = map(abs, pose)  # of NaN, no comparison holds
    is_near = x <= REACH_M and y <= REACH_M and z <= REACH_M
    return is_near and qx <= REACH_M and qy <= REACH_M and qz <= REACH_M and qw <= REACH_M


def to_matrix(x: float, y: float, z: float, w: float) -> Matrix:
    """Return the rotation matrix of a quaternion of any length but zero."""
    s = 2.0 / (x * x + y * y + z * z + w * w)
    xs, ys, zs = x * s, y * s, z * s
    wx, wy, wz = w * xs, w * ys, w * zs
    xx, xy, xz = x * xs, x * ys, x * zs
    yy, yz, zz = y * ys, y * zs, z * zs
    return (
        *(1.0 - (yy + zz), xy - wz, xz + wy),
        *(xy + wz, 1.0 - (xx + zz), yz - wx),
        *(xz - wy, yz + wx, 1.0 - (xx + yy)),
    )


def to_quaternion(matrix: Matrix) -> Quaternion:
    """Return the quaternion (x, y, z, w) of a rotation matrix, in the sign that tf2 gives it.

    With a positive trace w is positive, otherwise the component of the largest diagonal element is.
    The formula is the one of K. Shoemake, "Quaternion calculus and fast animation", SIGGRAPH 1987
    course notes 10. NaN in, NaN out.
    """
    m00, m01, m02, m10, m11, m12, m20, m21, m22 = matrix
    trace = m00 + m11 + m22
    if trace > 0.0:
        root = sqrt(trace + 1.0)
        s = 0.5 / root
        return (m21 - m12) * s, (m02 - m20) * s, (m10 - m01) * s, root * 0.5
    if m00 < m11:
        largest, square = (2, m22 - m00 - m11) if m11 < m22 else (1, m11 - m22 - m00)
    else:
        largest, square = (2, m22 - m00 - m11) if m00 < m22 else (0, m00 - m11 - m22)
    square += 1.0
    if not square > 0.0:
        return nan, nan, nan, nan
    root = sqrt(square)
    s = 0.5 / root
    if largest == 0:
        return root * 0.5, (m10 + m01) * s, (m20 + m02) * s, (m21 - m12) * s
    if largest == 1:
        return (m01 + m10) * s, root * 0.5, (m21 + m12) * s, (m02 - m20) * s
    return (m02 + m20) * s, (m12 + m21) * s, root * 0.5, (m10 - m01) * s


def canonical(x: float, y: float, z: float, w: float) -> Quaternion:
    """Return the rotation as tf2 returns it, by way of a matrix: normalised, with a defined sign.

    A quaternion of length zero or with NaN gives NaN.
    """
    square = x * x + y * y + z * z + w * w
    if square == 0.0:
        return nan, nan, nan, nan
    # `to_quaternion(to_matrix(...))` inlined for most rotations: it runs for every transform.
    s = 2.0 / square
    xs, ys, zs = x * s, y * s, z * s
    xx, yy, zz = x * xs, y * ys, z * zs
    trace = (1.0 - (yy + zz)) + (1.0 - (xx + zz)) + (1.0 - (xx + yy))
    if not trace > 0.0:
        return to_quaternion(to_matrix(x, y, z, w))
    wx, wy, wz = w * xs, w * ys, w * zs
    xy, xz, yz = x * ys, x * zs, y * zs
    root = sqrt(trace + 1.0)
    s = 0.5 / root
    return (
        ((yz + wx) - (yz - wx)) * s,
        ((xz + wy) - (xz - wy)) * s,
        ((xy + wz) - (xy - wz)) * s,
        root * 0.5,
    )


def compose_as_matrices(a: PoseTuple, b: PoseTuple) -> PoseTuple:
    """Return the pose `a * b` by way of rotation matrices, as tf2 joins two finished lookups."""
    ax, ay, az, *aq = a
    x, y, z, *bq = b
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = to_matrix(*aq)
    b0, b1, b2, b3, b4, b5, b6, b7, b8 = to_matrix(*bq)
    rotation = (
        *(b0 * a0 + b3 * a1 + b6 * a2, b1 * a0 + b4 * a1 + b7 * a2, b2 * a0 + b5 * a1 + b8 * a2),
        *(b0 * a3 + b3 * a4 + b6 * a5, b1 * a3 + b4 * a4 + b7 * a5, b2 * a3 + b5 * a4 + b8 * a5),
        *(b0 * a6 + b3 * a7 + b6 * a8, b1 * a6 + b4 * a7 + b7 * a8, b2 * a6 + b5 * a7 + b8 * a8),
    )
    return (
        a0 * x + a1 * y + a2 * z + ax,
        a3 * x + a4 * y + a5 * z + ay,
        a6 * x + a7 * y + a8 * z + az,
        *to_quaternion(rotation),
    )


def rotate(qx: Any, qy: Any, qz: Any, qw: Any, x: Any, y: Any, z: Any) -> Any:
    """Return the vector turned by a unit quaternion: q * v * q^-1, as two quaternion products."""
    tx = qw * x + qy * z - qz * y
    ty = qw * y + qz * x - qx * z
    tz = qw * z + qx * y - qy * x
    tw = -qx * x - qy * y - qz * z
    return (
        tx * qw - tw * qx - ty * qz + tz * qy,
        ty * qw - tw * qy - tz * qx + tx * qz,
        tz * qw - tw * qz - tx * qy + ty * qx,
    )


def compose(a: Any, b: Any) -> Any:
    """Return the pose `a * b`: first `b`, then `a`."""
    ax, ay, az, aqx, aqy, aqz, aqw = a
    x, y, z, bqx, bqy, bqz, bqw = b
    x, y, z = rotate(aqx, aqy, aqz, aqw, x, y, z)
    return (
        x + ax,
        y + ay,
        z + az,
        aqw * bqx + aqx * bqw + aqy * bqz - aqz * bqy,
        aqw * bqy + aqy * bqw + aqz * bqx - aqx * bqz,
        aqw * bqz + aqz * bqw + aqx * bqy - aqy * bqx,
        aqw * bqw - aqx * bqx - aqy * bqy - aqz * bqz,
    )


def inverse(a: Any) -> Any:
    """Return the pose that undoes `a`, whose rotation has unit length."""
    x, y, z, qx, qy, qz, qw = a
    return (*rotate(-qx, -qy, -qz, qw, -x, -y, -z), -qx, -qy, -qz, qw)


def interpolate(a: PoseTuple, b: PoseTuple, ratio: float) -> PoseTuple:
    """Straight line and great circle from `a` (ratio 0) to `b` (ratio 1), as tf2 does.

    The rotation takes the shorter way round: with a negative dot product `b` is negated.
    Slerp after K. Shoemake, "Animating rotation with quaternion curves", SIGGRAPH 1985.
    """
    ax, ay, az, aqx, aqy, aqz, aqw = a
    bx, by, bz, bqx, bqy, bqz, bqw = b
    rest = 1.0 - ratio
    x, y, z = rest * ax + ratio * bx, rest * ay + ratio * by, rest * az + ratio * bz
    dot = aqx * bqx + aqy * bqy + aqz * bqz + aqw * bqw
    norm = sqrt(
        (aqx * aqx + aqy * aqy + aqz * aqz + aqw * aqw)
        * (bqx * bqx + bqy * bqy + bqz * bqz + bqw * bqw)
    )
    cosine = abs(dot) / norm
    theta = acos(cosine) if cosine < 1.0 else 0.0
    if theta == 0.0:
        return x, y, z, aqx, aqy, aqz, aqw
    d = 1.0 / sin(theta)
    sa = sin(rest * theta)
    sb = sin(ratio * theta)
    if dot < 0.0:
        sb = -sb
    return (
        x,
        y,
        z,
        (aqx * sa + bqx * sb) * d,
        (aqy * sa + bqy * sb) * d,
        (aqz * sa + bqz * sb) * d,
        (aqw * sa + bqw * sb) * d,
    )
