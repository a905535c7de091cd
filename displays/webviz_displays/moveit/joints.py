"""Positions of joints in messages of MoveIt, and where they place the links of a robot."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Pose
from webviz.data.rotations import normalized
from webviz.data.words import counted
from webviz_displays.robot_model.joint_states import MAX_JOINTS, positions_of
from webviz_displays.robot_model.placing import poses_by_link
from webviz_displays.shared.geometry import is_drawable
from webviz_urdf import Kinematics, Robot

F64 = NDArray[np.float64]
NO_POSES: Mapping[str, Pose] = {}


class JointValues(msgspec.Struct, frozen=True):
    """The state of a robot's joints.

    Args:
        positions: by joint, rad or m; finite.
        poses: of the child in the joint's frame, by planar, floating or virtual joint.
        frame: that the root link is placed in, "" if unknown.
        faults: why some of them are left out, sentences.
    """

    positions: Mapping[str, float] = msgspec.field(default_factory=dict)
    poses: Mapping[str, Pose] = msgspec.field(default_factory=dict)
    frame: str = ""
    faults: tuple[str, ...] = ()

    @property
    def is_empty(self) -> bool:
        """Return whether nothing is known."""
        return not (self.positions or self.poses)

    def over(self, before: JointValues) -> JointValues:
        """Return the same, completed from an earlier state."""
        return JointValues(
            _bounded({**before.positions, **self.positions}),
            _bounded({**before.poses, **self.poses}),
            self.frame or before.frame,
            self.faults,
        )


def joints_of(state: Any) -> JointValues:
    """Return the joints in a moveit_msgs/RobotState."""
    positions, fault = positions_of(state.joint_state)
    several = state.multi_dof_joint_state
    poses, other = poses_of(several.joint_names, several.transforms)
    frame = state.joint_state.header.frame_id or several.header.frame_id
    faults = tuple(filter(None, (fault, other)))
    return JointValues(_bounded(positions), _bounded(poses), frame.lstrip("/"), faults)


def poses_of(names: Sequence[str], transforms: Sequence[Any]) -> tuple[dict[str, Pose], str]:
    """Return the poses of joints of several degrees of freedom by name, and what is wrong, or "".

    Args:
        names: of the joints.
        transforms: geometry_msgs/Transform, one for each.
    """
    poses: dict[str, Pose] = {}
    fault = ""
    if len(names) != len(transforms):
        joints, amount = counted(len(names), "name"), counted(len(transforms), "transform")
        return {}, f"The multi-DOF joints have {joints} but {amount}. Fix the publisher."
    for name, transform in zip(names, transforms, strict=True):
        at, turn = transform.translation, transform.rotation
        pose = pose_of((at.x, at.y, at.z), (turn.w, turn.x, turn.y, turn.z))
        if pose is None:
            fault = f"The transform of joint '{name:.80}' is invalid. Fix the publisher."
        else:
            poses[name] = pose
    return poses, fault


def pose_of(position: Iterable[float], wxyz: Iterable[float]) -> Pose | None:
    """Return a pose with a normalised quaternion, None if it cannot be drawn.

    Zeros are not a rotation.
    """
    quaternion = np.array([*wxyz], float)
    turns, ok = normalized(quaternion)
    x, y, z = position
    pose = Pose((x, y, z), tuple(turns[0].tolist()))
    is_valid = (bool(ok[0]) or not quaternion.any()) and bool(is_drawable((x, y, z)))
    return pose if is_valid else None


class Stance(msgspec.Struct, frozen=True, eq=False):
    """Poses of the links of a robot.

    Args:
        poses: by link, in the frame of the joints; those that cannot be drawn are left out.
        assumed: joints without a known position, which have their default.
        unknown_joints: joints that the robot does not have.
        outside: links whose joint is outside its limits.
    """

    poses: Mapping[str, Pose]
    assumed: tuple[str, ...]
    unknown_joints: tuple[str, ...]
    outside: tuple[str, ...]


class Poser:
    """Places the links of one robot.

    Args:
        robot: to place.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.kinematics = Kinematics(robot)
        self.columns = {name: column for column, name in enumerate(self.kinematics.joints)}
        limits = [robot.joints[name].limits or (0.0, 0.0) for name in self.kinematics.joints]
        lower, upper = np.array(limits, float).reshape(-1, 2).T
        middle = lower / 2 + upper / 2
        self.defaults = np.where((lower <= 0.0) & (upper >= 0.0), 0.0, middle)
        """Defaults of `Kinematics.joints`: 0, or the middle if that is outside the limits, as in
        MoveIt."""

    def values(self, positions: Mapping[str, float]) -> F64:
        """Positions of `Kinematics.joints`, float64 (J,)."""
        pairs = zip(self.columns, self.defaults.tolist(), strict=True)
        return np.array([positions.get(name, default) for name, default in pairs], float)

    def place(self, values: F64, poses: Mapping[str, Pose] = NO_POSES) -> dict[str, Pose]:
        """Return the poses of the links, given the joints.

        Args:
            values: float64 (J,), of `Kinematics.joints`.
            poses: of planar, floating and virtual joints; a virtual one places the root link.
        """
        free = self.kinematics.free
        moved = {name: pose for name, pose in poses.items() if name in free}
        virtual = [pose for name, pose in poses.items() if name not in self.robot.joints]
        base = virtual[0] if virtual else Pose()
        return poses_by_link(self.kinematics, *self.kinematics.places(values, moved, base))

    def stance(self, joints: JointValues) -> Stance:
        """Return where the links are, and what is odd about the joints."""
        robot, positions = self.robot, joints.positions
        values = self.values(positions)
        assumed = [name for name in self.columns if name not in positions]
        assumed += [name for name in self.kinematics.free if name not in joints.poses]
        return Stance(
            self.place(values, joints.poses),
            tuple(assumed),
            tuple(name for name in positions if name not in robot.joints),
            tuple(
                joint.child
                for joint, value in zip(self._joints(), values.tolist(), strict=True)
                if joint.limits and not joint.limits[0] - 1e-6 <= value <= joint.limits[1] + 1e-6
            ),
        )

    def _joints(self) -> list[Any]:
        return [self.robot.joints[name] for name in self.columns]


def _bounded(values: dict[str, Any]) -> dict[str, Any]:
    if len(values) <= MAX_JOINTS:
        return values
    return dict(list(values.items())[:MAX_JOINTS])
