"""Where a frame is in its parent, in words."""

from __future__ import annotations

import math

from webviz import Frames
from webviz.transforms import TransformException


def readout(frames: Frames, name: str) -> str | None:
    """The newest pose of a frame in its parent, None if there is none.

    Angles are roll, pitch and yaw about the parent's axes (URDF's order), in degrees.
    """
    cache = frames.buffer.tree.caches.get(name)
    newest = cache.newest if cache is not None else None
    if cache is None or newest is None:
        return None
    parent = newest[1]
    try:
        transform = frames.buffer.lookup(parent, name, 0)
    except TransformException:  # frames that form a loop
        return None
    kind = "static" if cache.is_static else "moving"
    position = ", ".join(f"{value:.3f}" for value in transform.translation)
    angles = ", ".join(
        f"{math.degrees(angle):.1f}" for angle in _roll_pitch_yaw(transform.rotation)
    )
    return (
        f"In '{parent}' ({kind}): position ({position}) m, roll, pitch and yaw ({angles}) degrees."
    )


def _roll_pitch_yaw(xyzw: tuple[float, float, float, float]) -> tuple[float, float, float]:
    """The angles of a unit quaternion, in radians."""
    x, y, z, w = xyzw
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return roll, pitch, yaw
