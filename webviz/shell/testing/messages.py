"""Parts of messages for tests."""

from __future__ import annotations

from typing import Any

from webviz.data.rotations import Quaternion, from_rpy, w_last
from webviz.shell.testing.source import SECOND

Vector = tuple[float, float, float]


def header(frame: str, stamp_ns: int) -> dict[str, Any]:
    """Return a std_msgs/Header as nested mappings."""
    sec, nanosec = divmod(stamp_ns, SECOND)
    return {"frame_id": frame, "stamp": {"sec": sec, "nanosec": nanosec}}


def stamped_transform(
    parent: str,
    child: str,
    stamp_ns: int,
    xyz: Vector = (0.0, 0.0, 0.0),
    xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0),
) -> dict[str, Any]:
    """Return a geometry_msgs/TransformStamped as nested mappings; metres and a unit quaternion."""
    return {
        "header": header(parent, stamp_ns),
        "child_frame_id": child,
        "transform": {
            "translation": dict(zip("xyz", xyz, strict=True)),
            "rotation": dict(zip("xyzw", xyzw, strict=True)),
        },
    }


def turned(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> Quaternion:
    """Return a quaternion (x, y, z, w) of rotations about fixed x, y, z in order, in rad."""
    return w_last(from_rpy(roll, pitch, yaw))
