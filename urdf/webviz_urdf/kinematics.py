"""Forward kinematics: where the links of a robot are, given the positions of its joints."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Pose
from webviz.data.rotations import matrices, multiply_many
from webviz_urdf.robot import Joint, Robot

F64 = NDArray[np.float64]

MOVABLE = ("revolute", "continuous", "prismatic")
"""Types of joints whose position is one number."""

_FREE = ("planar", "floating")
_NONE: Mapping[str, Pose] = MappingProxyType({})


class Kinematics:
    """Places all links of a robot at once, for one or for many sets of joint positions.

    Args:
        robot: whose joints form a tree.

    Attributes:
        links: names of the links, in the order of the results.
        joints: names of the joints whose positions are needed: movable ones that mimic no other,
            in the description's order.
        free: names of the planar and floating joints, which need a pose each.
    """

    def __init__(self, robot: Robot) -> None:
        self.links = tuple(robot.links)
        rows = {link: row for row, link in enumerate(self.links)}
        leaders = {name: leader_of(joint, robot.joints) for name, joint in robot.joints.items()}
        self.joints = tuple(
            name
            for name, joint in robot.joints.items()
            if joint.type in MOVABLE and leaders[name][0] == name
        )
        self.free = tuple(name for name, joint in robot.joints.items() if joint.type in _FREE)
        columns = {name: column for column, name in enumerate(self.joints)}
        count = len(self.links)
        self._parents = np.arange(count)
        self._origins = np.zeros((count, 3))
        self._turns = np.tile((1.0, 0.0, 0.0, 0.0), (count, 1))
        self._axes = np.zeros((count, 3))
        self._is_sliding = np.zeros(count, bool)
        # The last column stands for joints that do not move.
        self._columns = np.full(count, len(self.joints))
        self._multipliers = np.zeros(count)
        self._offsets = np.zeros(count)
        self._free_rows: dict[str, int] = {}
        for name, joint in robot.joints.items():
            row = rows[joint.child]
            self._parents[row] = rows[joint.parent]
            self._origins[row], self._turns[row] = joint.origin.position, joint.origin.wxyz
            if joint.type in _FREE:
                self._free_rows[name] = row
            if joint.type in MOVABLE:
                leader, self._multipliers[row], self._offsets[row] = leaders[name]
                self._columns[row] = columns.get(leader, len(self.joints))
                self._axes[row] = joint.axis
                self._is_sliding[row] = joint.type == "prismatic"

    def places(
        self, positions: F64, moved: Mapping[str, Pose] = _NONE, base: Pose = Pose()
    ) -> tuple[F64, F64]:
        """Return the poses of all links.

        Args:
            positions: float64 (..., J), one for each of `joints`, rad or m; finite.
            moved: of free joints, the pose of the child in the joint's frame; the identity for
                joints without one.
            base: pose of the root link.

        Returns:
            Positions float64 (..., L, 3) in metres and unit quaternions float64 (..., L, 4), w
            first, in the frame that `base` is given in. Those of links that huge multipliers of
            mimicking joints move are not finite.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            return self._places(positions, moved, base)

    def _places(self, positions: F64, moved: Mapping[str, Pose], base: Pose) -> tuple[F64, F64]:
        still = np.zeros((*positions.shape[:-1], 1))
        values = np.concatenate((positions, still), axis=-1)[..., self._columns]
        values = values * self._multipliers + self._offsets
        half = np.where(self._is_sliding, 0.0, values)[..., None] / 2.0
        turns = np.concatenate((np.cos(half), np.sin(half) * self._axes), axis=-1)
        wxyz = multiply_many(self._turns, turns)
        slides = np.where(self._is_sliding, values, 0.0)[..., None] * self._axes
        xyz = self._origins + _turned(np.broadcast_to(self._turns, turns.shape), slides)
        for name, pose in moved.items():
            row = self._free_rows[name]
            xyz[..., row, :] += _turned(self._turns[row], np.array(pose.position))
            wxyz[..., row, :] = multiply_many(self._turns[row], np.array(pose.wxyz))
        root = self._parents == np.arange(len(self.links))
        xyz[..., root, :], wxyz[..., root, :] = base.position, base.wxyz
        # Each round doubles the number of joints that are composed.
        parents = np.where(root, -1, self._parents)
        while (below := np.flatnonzero(parents >= 0)).size:
            above = parents[below]
            outer = wxyz[..., above, :]
            xyz_next = xyz[..., above, :] + _turned(outer, xyz[..., below, :])
            wxyz_next = multiply_many(outer, wxyz[..., below, :])
            xyz[..., below, :], wxyz[..., below, :] = xyz_next, wxyz_next
            parents[below] = parents[above]
        return xyz, wxyz

    def moved_by(self, joints: Collection[str]) -> set[str]:
        """Return the links that any of `joints` or `free` moves, directly or through others."""
        chosen = np.array([name in joints for name in self.joints] + [False])
        moved = chosen[self._columns]
        moved[[row for name, row in self._free_rows.items() if name in joints]] = True
        parents = self._parents
        while True:
            moved = moved | moved[parents]
            above = parents[parents]
            if (above == parents).all():
                break
            parents = above
        return {self.links[row] for row in np.flatnonzero(moved)}


def leader_of(joint: Joint, joints: Mapping[str, Joint]) -> tuple[str, float, float]:
    """Return the joint that decides the position of a joint, with multiplier and offset.

    One that mimics an unknown joint, or itself, decides its own.
    """
    name, multiplier, offset = joint.name, 1.0, 0.0
    visited = {name}
    current = joint
    while (mimic := current.mimic) and mimic.joint in joints:
        if mimic.joint in visited:
            return joint.name, 1.0, 0.0
        offset += multiplier * mimic.offset
        multiplier *= mimic.multiplier
        current = joints[mimic.joint]
        name = current.name
        visited.add(name)
    return name, multiplier, offset


def _turned(wxyz: F64, xyz: F64) -> F64:
    """Vectors (..., 3) turned by unit quaternions (..., 4)."""
    return (matrices(wxyz) @ xyz[..., None])[..., 0]
