"""Lines that make a tried pose last: for a description, and for a terminal."""

from __future__ import annotations

import shlex
from xml.sax.saxutils import quoteattr

from webviz.api.nodes import Pose
from webviz.data.rotations import to_rpy


def urdf_origin(pose: Pose) -> str:
    """Return the origin of a joint with a pose, for a URDF or xacro file."""
    values = pose.position, to_rpy(pose.wxyz)
    xyz, rpy = (quoteattr(" ".join(map(_text, each))) for each in values)
    return f"<origin xyz={xyz} rpy={rpy}/>"


def static_transform_publisher(parent: str, frame: str, pose: Pose) -> str:
    """Return the command that publishes the pose of a frame in its parent."""
    names = "x", "y", "z", "roll", "pitch", "yaw"
    values = zip(names, (*pose.position, *to_rpy(pose.wxyz)), strict=True)
    numbers = " ".join(f"--{name} {_text(value)}" for name, value in values)
    frames = f"--frame-id {shlex.quote(parent)} --child-frame-id {shlex.quote(frame)}"
    return f"ros2 run tf2_ros static_transform_publisher {numbers} {frames}"


def _text(value: float) -> str:
    """To a tenth of a millimetre or of a milliradian, without a negative zero."""
    return f"{round(value, 4) + 0.0:g}"
