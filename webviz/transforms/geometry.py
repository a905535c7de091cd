"""Rigid transforms as tf2 computes them, operation by operation.

A pose is seven numbers `(x, y, z, qx, qy, qz, qw)`: it maps coordinates of a child frame into its
parent. The order of the floating point operations is tf2's own: the sign that the conversion from
matrix to quaternion gives to a rotation by 120 or 180 degrees hangs on the last bit.
`rotate`, `compose` and `inverse` work elementwise: on floats and on the rows of a (7, N) array.
"""

from __future__ import annotations

from math import acos, sin, sqrt
from typing import Any

Pose = tuple[float, float, float, float, float, float, float]
Quaternion = tuple[float, float, float, float]

IDENTITY: Pose = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def canonical(x: float, y: float, z: float, w: float) -> Quaternion | None:
    """The same rotation after tf2's way through a rotation matrix: normalised, of defined sign.

    With a positive trace w is positive, otherwise the component of the largest diagonal element is.
    The conversion is the one described by K. Shoemake, "Quaternion calculus and fast animation",
    SIGGRAPH 1987 course notes 10.

    Returns:
        The unit quaternion `(x, y, z, w)`, or None if no rotation comes out: zero length or NaN.
    """
    length2 = x * x + y * y + z * z + w * w
    if length2 == 0.0:
        return None
    s = 2.0 / length2
    xs, ys, zs = x * s, y * s, z * s
    wx, wy, wz = w * xs, w * ys, w * zs
    xx, xy, xz = x * xs, x * ys, x * zs
    yy, yz, zz = y * ys, y * zs, z * zs
    m00, m11, m22 = 1.0 - (yy + zz), 1.0 - (xx + zz), 1.0 - (xx + yy)
    trace = m00 + m11 + m22
    if trace > 0.0:
        root = sqrt(trace + 1.0)
        s = 0.5 / root
        return (
            ((yz + wx) - (yz - wx)) * s,
            ((xz + wy) - (xz - wy)) * s,
            ((xy + wz) - (xy - wz)) * s,
            root * 0.5,
        )
    largest = (2 if m11 < m22 else 1) if m00 < m11 else (2 if m00 < m22 else 0)
    if largest == 0:
        square = m00 - m11 - m22 + 1.0
    elif largest == 1:
        square = m11 - m22 - m00 + 1.0
    else:
        square = m22 - m00 - m11 + 1.0
    if not square > 0.0:
        return None
    root = sqrt(square)
    s = 0.5 / root
    sum_xy = ((xy + wz) + (xy - wz)) * s
    sum_xz = ((xz - wy) + (xz + wy)) * s
    sum_yz = ((yz + wx) + (yz - wx)) * s
    if largest == 0:
        return root * 0.5, sum_xy, sum_xz, ((yz + wx) - (yz - wx)) * s
    if largest == 1:
        return sum_xy, root * 0.5, sum_yz, ((xz + wy) - (xz - wy)) * s
    return sum_xz, sum_yz, root * 0.5, ((xy + wz) - (xy - wz)) * s


def rotate(qx: Any, qy: Any, qz: Any, qw: Any, x: Any, y: Any, z: Any) -> Any:
    """The vector turned by a unit quaternion: q * v * q^-1, as two quaternion products."""
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
    """The pose `a * b`: first `b`, then `a`."""
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
    """The pose that undoes `a`, whose rotation has unit length."""
    x, y, z, qx, qy, qz, qw = a
    return (*rotate(-qx, -qy, -qz, qw, -x, -y, -z), -qx, -qy, -qz, qw)


def interpolate(a: Pose, b: Pose, ratio: float) -> Pose:
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
