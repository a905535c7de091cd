"""A robot as the viewer needs it: links with things to draw, joints, and what could not be read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Glb, Mesh, Pose
from webviz_urdf.joints import Joint
from webviz_urdf.kinematics import forward_kinematics


class RobotDescriptionError(Exception):
    """A robot description that cannot be drawn at all; the text is one sentence that says why."""


@dataclass(frozen=True)
class Shape:
    """One visual or collision element, ready to draw.

    Args:
        name: unique within its link and kind.
        pose: of the node in the link's frame.
        node: with the mesh's unit and scale applied.
    """

    name: str
    pose: Pose
    node: Mesh | Glb


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
    visuals: tuple[Shape, ...] = ()
    collisions: tuple[Shape, ...] = ()
    inertial: Inertial | None = None


@dataclass(frozen=True)
class Missing:
    """A visual or collision that is not drawn.

    Args:
        link: whose it is.
        uri: the mesh as the description names it; empty if it names none.
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
        root: the link that has no parent.
        links: by name, in the description's order.
        joints: by name, in the description's order.
        missing: what is not drawn, and why.
        warnings: sentences about what was put up with.
    """

    name: str
    root: str
    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    missing: tuple[Missing, ...] = ()
    warnings: tuple[str, ...] = ()

    def fk(self, joint_positions: Mapping[str, float] | None = None) -> dict[str, Pose]:
        """Pose of every link in the root link's frame.

        Args:
            joint_positions: rad or m by joint name; joints left out stand at 0, names that are no
                joints are ignored, and so are positions of mimic joints, which their leader sets.
        """
        return forward_kinematics(self.root, self.joints, joint_positions or {})
