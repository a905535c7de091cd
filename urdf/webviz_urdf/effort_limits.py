"""The joints of a description that can have a torque, without reading its shapes."""

from __future__ import annotations

import math

from webviz_urdf.document import parse_document
from webviz_urdf.robot import RobotDescriptionError, TurningJoint

TURNING = ("revolute", "continuous")
"""Types of joints whose effort is a torque about their axis."""


def turning_joints(text: str) -> dict[str, TurningJoint]:
    """Return the joints of URDF text that turn, by name.

    Raises:
        RobotDescriptionError: it is not a robot; one sentence says why.
    """
    joints = {}
    for element in parse_document(text).root.iterfind("joint"):
        if element.get("type") not in TURNING:
            continue
        name = element.get("name", "")
        if name in joints:
            raise RobotDescriptionError(f"Two joints are named '{name}'.")
        axis, limit = element.find("axis"), element.find("limit")
        x, y, z = _numbers(axis, "xyz") or (1.0, 0.0, 0.0)  # URDF's default
        length = math.hypot(x, y, z)
        (most,) = _numbers(limit, "effort") or (0.0,)
        if length:
            joints[name] = TurningJoint(
                element.find("child").get("link", ""),
                (x / length, y / length, z / length),
                most if 0 < most < math.inf else 0.0,
            )
    return joints


def _numbers(element: object, name: str) -> tuple[float, ...]:
    """Return the numbers of an attribute, none if it is missing."""
    text = "" if element is None else element.get(name, "")  # pyright: ignore
    return tuple(map(float, text.split()))
