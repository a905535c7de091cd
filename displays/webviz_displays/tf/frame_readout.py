"""The pose of a frame in its parent and in the fixed frame, as text."""

from __future__ import annotations

import math

from webviz import Frames
from webviz.data.transforms import TransformException

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


def readout(frames: Frames, name: str) -> str | None:
    """The newest pose of a frame in its parent and in the fixed frame, None if there is none.

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
    text = f"In '{parent}' ({kind}): {_words(transform.translation, transform.rotation)}."
    pose = frames.latest(name)
    if pose is None or parent == frames.fixed_frame:
        return text
    w, x, y, z = pose.wxyz
    return f"{text} In '{frames.fixed_frame}': {_words(pose.position, (x, y, z, w))}."


def _words(position: Vector, xyzw: Quaternion) -> str:
    x, y, z = position
    roll, pitch, yaw = map(math.degrees, _roll_pitch_yaw(xyzw))
    return (
        f"position ({x:.3f}, {y:.3f}, {z:.3f}) m, "
        f"roll, pitch and yaw ({roll:.1f}, {pitch:.1f}, {yaw:.1f}) degrees"
    )


def _roll_pitch_yaw(xyzw: Quaternion) -> Vector:
    """The angles of a unit quaternion, in radians."""
    x, y, z, w = xyzw
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return roll, pitch, yaw
