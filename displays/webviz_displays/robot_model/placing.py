"""Poses of the links of a robot: by their transforms, or by the positions of its joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from webviz import Context, Frames, Group, Pose, compose
from webviz.api.frames import is_placeable
from webviz.data.transforms import Explanation, distinct
from webviz_displays.robot_model.joint_states import ReceivedRobot
from webviz_displays.robot_model.statuses import NAMED, why_lost
from webviz_urdf import Kinematics, Robot

F64 = NDArray[np.float64]


class Placing(Protocol):
    """Places links.

    Attributes:
        source: of the poses.
        lacks: what a link without a pose has not.
    """

    source: str
    lacks: str

    def frame(self, link: str) -> str:
        """Return the frame that places a link."""
        ...

    def pose(self, link: str, frames: Frames) -> Pose | None:
        """Return the pose of a link in the fixed frame, None if it is unknown."""
        ...

    def group(self, link: str, ctx: Context, interval_s: float) -> Group:
        """Return a group that moves with a link; without a pose it stays at the last one."""
        ...

    def reasons(self, robot: Robot, links: Sequence[str], frames: Frames) -> dict[str, Explanation]:
        """Return why links have no pose, unless another status says it: one sentence per cause."""
        ...


class ByTransforms:
    """Each link follows its own frame.

    Args:
        prefix: of frame ids.
    """

    source, lacks = "transforms", "a transform"

    def __init__(self, prefix: str) -> None:
        self._prefix = prefix

    def frame(self, link: str) -> str:
        """Return the link's own frame."""
        return self._prefix + link

    def pose(self, link: str, frames: Frames) -> Pose | None:
        """Return the latest pose of the link's frame."""
        return frames.latest(self._prefix + link)

    def group(self, link: str, ctx: Context, interval_s: float) -> Group:
        """Return a group in the link's frame."""
        return ctx.follow(self._prefix + link, keep_last=True, interval_s=interval_s)

    def reasons(self, robot: Robot, links: Sequence[str], frames: Frames) -> dict[str, Explanation]:
        """Return why the links' frames have no transforms, by the first link with each reason."""
        return distinct(
            links, lambda link: why_lost(robot, link, frames.explain(self.frame(link))), NAMED
        )


class ByJoints:
    """All links follow the frame of the root link, at the poses that the joints give them.

    Args:
        root: frame of the root link.
        poses: of links in that frame; those that cannot be drawn are left out.
        total: joints that need a position.
        missing: those without a known one, which is taken for 0.
        assumed: links that such joints move.
        fault: why the newest joint state is invalid, or "".
    """

    source, lacks = "joint states", "a known pose"

    def __init__(
        self,
        root: str,
        poses: Mapping[str, Pose],
        total: int,
        missing: Sequence[str],
        assumed: set[str],
        fault: str,
    ) -> None:
        self._root = root
        self._poses = poses
        self._assumed = assumed
        self.total = total
        self.missing = missing
        self.fault = fault

    def frame(self, link: str) -> str:
        """Return the frame of the root link."""
        return self._root

    def pose(self, link: str, frames: Frames) -> Pose | None:
        """Return the pose of a link if all joints up to the root have a position."""
        if link in self._assumed or link not in self._poses:
            return None
        base = frames.latest(self._root)
        return base and compose(base, self._poses[link])

    def group(self, link: str, ctx: Context, interval_s: float) -> Group:
        """Return a group at the link in the frame of the root link."""
        return ctx.follow(
            self._root, offset=self._poses.get(link, Pose()), keep_last=True, key=link
        )

    def reasons(self, robot: Robot, links: Sequence[str], frames: Frames) -> dict[str, Explanation]:
        """Return why the root link has no transform."""
        return {} if frames.latest(self._root) else {robot.root: frames.explain(self._root)}


class JointPlacer:
    """Places one robot by joint states.

    Args:
        robot: to place.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self._kinematics = Kinematics(robot)
        self._round: object = None
        self._placing: ByJoints | None = None

    def place(self, root: str, received: ReceivedRobot, round: object) -> ByJoints:
        """Places for the positions received.

        Args:
            root: frame of the root link.
            received: positions of joints.
            round: the links stay while this does; None for no such limit.
        """
        if self._placing is None or round is None or round != self._round:
            self._placing, self._round = self._placed(root, received), round
        return self._placing

    def _placed(self, root: str, received: ReceivedRobot) -> ByJoints:
        kinematics, positions = self._kinematics, received.positions
        values = np.array([positions.get(joint, 0.0) for joint in kinematics.joints], float)
        needed = {*kinematics.joints, *kinematics.free}
        missing = [
            joint for joint in self.robot.joints if joint in needed and joint not in positions
        ]
        poses = poses_by_link(kinematics, *kinematics.places(values))
        assumed = kinematics.moved_by(missing)
        return ByJoints(root, poses, len(needed), missing, assumed, received.fault)


def poses_by_link(kinematics: Kinematics, xyz: F64, wxyz: F64) -> dict[str, Pose]:
    """Return the poses of links by name, from one result of `Kinematics.places`.

    Only drawable ones.
    """
    rows = zip(kinematics.links, xyz.tolist(), wxyz.tolist(), strict=True)
    poses = {link: Pose(tuple(position), tuple(turn)) for link, position, turn in rows}
    return {link: pose for link, pose in poses.items() if is_placeable(pose)}
