"""A loaded robot: links with shapes, joints, and the shapes that could not be read."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Glb, Mesh, Pose

Progress = Callable[[int, int, str], None]
"""Called with the number of shapes done, their total, and the name of the current link."""

JOINT_TYPES = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")


class RobotDescriptionError(Exception):
    """A robot description cannot be used; the text is one sentence that says why."""


@dataclass(frozen=True)
class RobotShape:
    """One visual or collision element, ready to draw.

    Args:
        name: unique within its link and kind.
        pose: of the node in the link's frame.
        node: with the mesh's unit and scale applied.
        source: the mesh as the description names it, "" for a box, sphere or cylinder.
    """

    name: str
    pose: Pose
    node: Mesh | Glb
    source: str = ""


@dataclass(frozen=True)
class Inertial:
    """Mass properties of a link.

    Args:
        mass: kg.
        com: pose of the centre of mass, and of the axes of `inertia`, in the link's frame.
        inertia: float64 (3, 3), kg m², about the centre of mass.
    """

    mass: float
    com: Pose
    inertia: NDArray[np.float64]


@dataclass(frozen=True)
class Link:
    """A rigid body of the robot."""

    name: str
    visuals: tuple[RobotShape, ...] = ()
    collisions: tuple[RobotShape, ...] = ()
    inertial: Inertial | None = None


@dataclass(frozen=True)
class Mimic:
    """A joint that moves with another: its position is `multiplier` times the other's + `offset`.

    Args:
        joint: name of the other joint.
        multiplier: without unit.
        offset: rad or m.
    """

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Joint:
    """Motion of a child link relative to its parent.

    Args:
        name: unique in the robot.
        type: one of `JOINT_TYPES`.
        parent, child: link names.
        origin: pose of the joint's frame, the child's at position 0, in the parent's frame.
        axis: unit vector in the joint's frame; zero if the description gives no direction.
        limits: lower and upper position in rad or m; None without limits.
        mimic: the joint that it moves with, if any.
    """

    name: str
    type: str
    parent: str
    child: str
    origin: Pose
    axis: tuple[float, float, float]
    limits: tuple[float, float] | None
    mimic: Mimic | None = None


@dataclass(frozen=True)
class TurningJoint:
    """A joint that turns.

    Args:
        child: its link, in whose frame the axis is.
        axis: unit vector.
        max_effort: Nm, 0 if the description gives none.
    """

    child: str
    axis: tuple[float, float, float]
    max_effort: float


@dataclass(frozen=True)
class MissingShape:
    """A visual or collision that is not drawn.

    Args:
        link: its name.
        uri: the mesh as the description names it, "" without a mesh.
        reason: one sentence.
        kind: "visual" or "collision".
    """

    link: str
    uri: str
    reason: str
    kind: str = "visual"


@dataclass(frozen=True)
class Robot:
    """A loaded robot description.

    Every `<visual>` of the description is either in a link's `visuals` or in `missing`.

    Args:
        name: "robot" if the description gives none.
        root: the link without a parent.
        links: by name, in the description's order.
        joints: by name, in the description's order.
        missing: shapes that are not drawn.
        warnings: sentences about tolerated faults.
    """

    name: str
    root: str
    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    missing: tuple[MissingShape, ...] = ()
    warnings: tuple[str, ...] = ()
