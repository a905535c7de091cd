"""Rotations in words that people think in."""

from __future__ import annotations

from webviz.data.rotations import Quaternion, from_rpy, w_last


def turned(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> Quaternion:
    """A rotation (x, y, z, w) about the fixed axes x, y, z in this order, in radians."""
    return w_last(from_rpy(roll, pitch, yaw))
