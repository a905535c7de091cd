"""The joints of a description, without reading its shapes."""

from __future__ import annotations

import math

from webviz.api.nodes import Pose
from webviz_urdf.document import parse_document
from webviz_urdf.kinematics import MOVABLE
from webviz_urdf.robot import Joint, Mimic, RobotDescriptionError, TurningJoint

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


def moving_joints(text: str) -> dict[str, Joint]:
    """Return the revolute, continuous and prismatic joints of URDF text, by name.

    Their origins and axes are not read. Limits are None if they are missing, no numbers, or
    reversed; those of continuous joints always are.

    Raises:
        RobotDescriptionError: it is not a robot; one sentence says why.
    """
    joints: dict[str, Joint] = {}
    for element in parse_document(text).root.iterfind("joint"):
        kind, name = element.get("type", ""), element.get("name", "")
        if kind not in MOVABLE:
            continue
        if name in joints:
            raise RobotDescriptionError(f"Two joints are named '{name}'.")
        limit, mimic = element.find("limit"), element.find("mimic")
        limits = None
        if limit is not None and kind != "continuous":
            lower, upper = _number(limit, "lower", 0.0), _number(limit, "upper", 0.0)
            limits = (lower, upper) if lower < upper else None
        leader = None
        if mimic is not None:
            factor, offset = _number(mimic, "multiplier", 1.0), _number(mimic, "offset", 0.0)
            leader = Mimic(mimic.get("joint", ""), factor, offset)
        joints[name] = Joint(name, kind, "", "", Pose(), (0.0, 0.0, 0.0), limits, leader)
    return joints


def _number(element: object, name: str, default: float) -> float:
    """Return an attribute as a finite number; the default if it is missing or none."""
    try:
        value = float(element.get(name, default))  # pyright: ignore
    except ValueError:
        return default
    return value if math.isfinite(value) else default
