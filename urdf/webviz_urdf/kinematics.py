"""Poses as rigid motions, and where the links of a robot are for given joint positions."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Pose
from webviz_urdf.joints import Joint

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
IDENTITY = Pose()


def compose(outer: Pose, inner: Pose) -> Pose:
    """The pose `inner`, given in the frame of `outer`, seen from the frame of `outer`'s own."""
    x, y, z = rotate(outer.wxyz, inner.position)
    px, py, pz = outer.position
    return Pose((px + x, py + y, pz + z), multiply(outer.wxyz, inner.wxyz))


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """The rotation `b` followed by the rotation `a`."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def rotate(wxyz: Quaternion, vector: Vector) -> Vector:
    """`vector` turned by a unit quaternion."""
    w, x, y, z = wxyz
    conjugate = (w, -x, -y, -z)
    _, rx, ry, rz = multiply(multiply(wxyz, (0.0, *vector)), conjugate)
    return rx, ry, rz


def from_axis_angle(axis: Vector, angle: float) -> Quaternion:
    """Rotation by `angle` rad about the unit vector `axis`; a zero axis gives no rotation."""
    if not any(axis):
        return 1.0, 0.0, 0.0, 0.0
    s = math.sin(angle / 2.0)
    return math.cos(angle / 2.0), s * axis[0], s * axis[1], s * axis[2]


def rotation_matrix(pose: Pose) -> NDArray[np.float64]:
    """float64 (3, 3): columns are the pose's axes in the outer frame."""
    w, x, y, z = pose.wxyz
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
    )


def joint_position(name: str, joints: Mapping[str, Joint], positions: Mapping[str, float]) -> float:
    """Position of a joint, mimic chains followed to the joint that leads them."""
    multiplier, offset = 1.0, 0.0
    while (mimic := joints[name].mimic) is not None:
        offset += multiplier * mimic.offset
        multiplier *= mimic.multiplier
        name = mimic.joint
    return multiplier * positions.get(name, 0.0) + offset


def forward_kinematics(
    root: str, joints: Mapping[str, Joint], positions: Mapping[str, float]
) -> dict[str, Pose]:
    """Pose of every link below `root` in its frame; floating and planar joints stand still."""
    below: dict[str, list[Joint]] = {}
    for joint in joints.values():
        below.setdefault(joint.parent, []).append(joint)
    poses = {root: Pose()}
    pending = [root]
    while pending:
        parent = pending.pop()
        for joint in below.get(parent, ()):
            motion = _motion(joint, joint_position(joint.name, joints, positions))
            poses[joint.child] = compose(compose(poses[parent], joint.origin), motion)
            pending.append(joint.child)
    return poses


def _motion(joint: Joint, position: float) -> Pose:
    if joint.type in ("revolute", "continuous"):
        return Pose(wxyz=from_axis_angle(joint.axis, position))
    if joint.type == "prismatic":
        x, y, z = joint.axis
        return Pose((x * position, y * position, z * position))
    return Pose()
