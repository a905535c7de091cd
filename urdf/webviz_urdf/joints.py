"""How the links of a robot hang together."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.api.nodes import Pose

JOINT_TYPES = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")


@dataclass(frozen=True)
class Mimic:
    """A joint follows another: position = multiplier * that joint's position + offset."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Joint:
    """How a child link moves relative to its parent.

    Args:
        name: unique in the robot.
        type: one of `JOINT_TYPES`.
        parent, child: link names.
        origin: pose of the joint's frame, the child's at position 0, in the parent's frame.
        axis: unit vector in the joint's frame; zero if the description gives no direction.
        limits: lower and upper position in rad or m; None without limits.
        mimic: the joint that this one follows.
    """

    name: str
    type: str
    parent: str
    child: str
    origin: Pose = Pose()
    axis: tuple[float, float, float] = (1.0, 0.0, 0.0)
    limits: tuple[float, float] | None = None
    mimic: Mimic | None = None
