"""Rotations in words that people think in."""

from __future__ import annotations

import math


def turned(
    roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0
) -> tuple[float, float, float, float]:
    """A rotation (x, y, z, w) about the fixed axes x, y, z in this order, in radians."""
    (cr, sr), (cp, sp), (cy, sy) = (
        (math.cos(angle / 2), math.sin(angle / 2)) for angle in (roll, pitch, yaw)
    )
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
