"""Trajectories of robots as arrays of joint positions over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Pose
from webviz.data.messages import JointTrajectoryPointSequence
from webviz.data.words import counted
from webviz_displays.moveit.joints import JointValues, Poser, joints_of, poses_of
from webviz_displays.moveit.scene import Attached, KnownScene, updated_state
from webviz_displays.shared.geometry import FARTHEST

F64 = NDArray[np.float64]
MAX_POINTS = 100_000
"""Largest number of points of a path; further ones are left out."""


class JointPath(msgspec.Struct, frozen=True, eq=False):
    """States of a robot over time.

    Args:
        times: float64 (N,), seconds since the first, never decreasing.
        values: float64 (N, J), of `Kinematics.joints`, rad or m.
        poses: of joints of several degrees of freedom, for each of the N states.
        frame: that the root link is placed in, "" if unknown.
        moving: joints that the trajectory names.
        attached: what the robot holds.
        unknown_joints: joints that the robot does not have.
        faults: what is left out and why, sentences.
        model: name of the robot that it is for, "" if not said.
    """

    times: F64
    values: F64
    poses: Sequence[Mapping[str, Pose]]
    frame: str = ""
    moving: tuple[str, ...] = ()
    attached: Mapping[str, Attached] | None = None
    unknown_joints: tuple[str, ...] = ()
    faults: tuple[str, ...] = ()
    model: str = ""

    def __len__(self) -> int:
        return len(self.times)


def path_of(message: Any, poser: Poser) -> JointPath:
    """Return a moveit_msgs/DisplayTrajectory: its trajectories one after another."""
    scene = updated_state(KnownScene(), message.trajectory_start)
    builder = _Builder(poser, scene.joints)
    for each in message.trajectory:
        builder.add(each)
    start = joints_of(message.trajectory_start)
    names = tuple(builder.names)
    unknown_joints = [name for name in (*start.positions, *names) if name not in poser.robot.joints]
    faults = (*start.faults, *scene.faults, *builder.faults)
    times = np.array(builder.times, float)
    return JointPath(
        times - times[:1],
        np.array(builder.values, float).reshape(len(times), len(poser.columns)),
        builder.poses,
        start.frame or builder.frame,
        names,
        scene.attached,
        tuple(dict.fromkeys(unknown_joints)),
        tuple(dict.fromkeys(faults)),
        message.model_id,
    )


class _Builder:
    """Collects the states of several trajectories.

    Args:
        poser: of the robot.
        start: its joints before the first.
    """

    def __init__(self, poser: Poser, start: JointValues) -> None:
        self._poser = poser
        self._values = poser.values(start.positions)
        self._poses: Mapping[str, Pose] = start.poses
        self.times: list[float] = []
        self.values: list[F64] = []
        self.poses: list[Mapping[str, Pose]] = []
        self.names: dict[str, None] = {}
        self.faults: list[str] = []
        self.frame = ""

    def add(self, trajectory: Any) -> None:
        """Append a moveit_msgs/RobotTrajectory."""
        single, several = trajectory.joint_trajectory, trajectory.multi_dof_joint_trajectory
        self.names |= dict.fromkeys(single.joint_names)
        frame = single.header.frame_id or several.header.frame_id
        self.frame = self.frame or frame.lstrip("/")
        columns = [self._poser.columns.get(name) for name in single.joint_names]
        indices = [index for index, column in enumerate(columns) if column is not None]
        targets = [column for column in columns if column is not None]
        count = max(len(single.points), len(several.points))
        begin = self.times[-1] if self.times else 0.0
        before = begin if self.times else None
        rows = self._rows(single.points, len(columns))
        times = single.points.times_ns[:MAX_POINTS].tolist()
        for index in range(count):
            if len(self.times) >= MAX_POINTS:
                self.faults.append(f"Only the first {MAX_POINTS} points are kept.")
                return
            row = rows.get(index)
            if row is not None and indices:
                self._values = self._values.copy()
                self._values[targets] = row[indices]
            if index < len(several.points):
                transforms = several.points[index].transforms
                poses, fault = poses_of(several.joint_names, transforms)
                self._poses = {**self._poses, **poses}
                self.faults += [fault] if fault else []
            is_single = index < len(times)
            time_ns = times[index] if is_single else several.points[index].time_from_start.ns
            time_s = begin + time_ns / 1e9
            before = time_s if before is None else max(before, time_s)
            self.times.append(before)
            self.values.append(self._values)
            self.poses.append(self._poses)

    def _rows(self, points: JointTrajectoryPointSequence, width: int) -> dict[int, F64]:
        """Return the positions of each point that has valid ones."""
        numbers, rows = points.positions(width, MAX_POINTS)
        valid = (np.abs(rows) < FARTHEST).all(axis=1)
        if wrong := min(len(points), MAX_POINTS) - int(valid.sum()):
            self.faults.append(
                f"{counted(wrong, 'point')} without a valid position for each joint. "
                "Fix the publisher."
            )
        return dict(zip(numbers[valid].tolist(), rows[valid], strict=True))
