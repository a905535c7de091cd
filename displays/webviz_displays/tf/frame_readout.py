"""The pose of a frame in its parent and in the fixed frame, for people."""

from __future__ import annotations

import math

from webviz import Details, Frames, Pose
from webviz.api.frames import to_pose
from webviz.data.rotations import to_rpy


def readout(frames: Frames, name: str) -> str | None:
    """Return the newest pose of a frame in its parent and in the fixed frame, None if unknown.

    Angles are roll, pitch and yaw about the parent's axes (URDF's order), in degrees.
    """
    if (link := frames.link(name)) is None:
        return None
    kind = "static" if link.is_static else "moving"
    text = f"In '{link.parent}' ({kind}): {_words(to_pose(link.transform))}."
    pose = frames.latest(name)
    if pose is None or link.parent == frames.fixed_frame:
        return text
    return f"{text} In '{frames.fixed_frame}': {_words(pose)}."


def details(frames: Frames, name: str) -> Details | None:
    """Return the current details of a frame, None if it is unknown."""
    link, pose = frames.link(name), frames.latest(name)
    if link is None and pose is None:
        return None
    values: dict[str, object] = {"Parent": "none: it is a root" if link is None else link.parent}
    if link is not None:
        age_s = (frames.now_ns - link.transform.stamp_ns) / 1e9
        values["Age"] = "static" if link.is_static else f"{age_s:.2f} s"
        values[f"Pose in {link.parent}"] = to_pose(link.transform)
    if pose is not None and (link is None or link.parent != frames.fixed_frame):
        values[f"Pose in {frames.fixed_frame}"] = pose
    return Details(f"Frame {name}", values)


def _words(pose: Pose) -> str:
    x, y, z = pose.position
    roll, pitch, yaw = map(math.degrees, to_rpy(pose.wxyz))
    return (
        f"position ({x:.3f}, {y:.3f}, {z:.3f}) m, "
        f"roll, pitch and yaw ({roll:.1f}, {pitch:.1f}, {yaw:.1f}) degrees"
    )
