"""Where the links of a robot are for given joint positions."""

from __future__ import annotations

from collections.abc import Mapping

from webviz.api.frames import compose
from webviz.api.nodes import Pose
from webviz.data.rotations import from_axis_angle
from webviz_urdf.joints import Joint


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
