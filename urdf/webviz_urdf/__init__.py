"""Robot descriptions: URDF and meshes as plain data that a viewer can draw."""

import importlib
from typing import TYPE_CHECKING

from webviz_urdf.glb import (
    MeshContent,
    MeshPart,
    PictureFile,
    Surface,
    glb_parts,
    glb_with,
    write_glb,
)
from webviz_urdf.inertia import inertia_box, mass_sphere
from webviz_urdf.kinematics import Kinematics, leader_of
from webviz_urdf.loading import Loading, LoadingStopped, LoadRequest
from webviz_urdf.resolve import ResolveError, Resolver
from webviz_urdf.robot import (
    Inertial,
    Joint,
    Link,
    Mimic,
    MissingShape,
    Progress,
    Robot,
    RobotDescriptionError,
    RobotShape,
    TurningJoint,
)

if TYPE_CHECKING:
    from webviz_urdf.joints import moving_joints, turning_joints
    from webviz_urdf.load import load_file, load_robot

__all__ = [
    "Inertial",
    "Joint",
    "Kinematics",
    "Link",
    "LoadRequest",
    "Loading",
    "LoadingStopped",
    "MeshContent",
    "MeshPart",
    "Mimic",
    "MissingShape",
    "PictureFile",
    "Progress",
    "ResolveError",
    "Resolver",
    "Robot",
    "RobotDescriptionError",
    "RobotShape",
    "Surface",
    "TurningJoint",
    "glb_parts",
    "glb_with",
    "inertia_box",
    "leader_of",
    "load_file",
    "load_robot",
    "mass_sphere",
    "moving_joints",
    "turning_joints",
    "write_glb",
]


def __getattr__(name: str) -> object:
    """Import what reads files when it is asked for: it takes longer than all of a viewer."""
    if name == "turning_joints":
        return importlib.import_module("webviz_urdf.joints").turning_joints
    if name == "moving_joints":
        return importlib.import_module("webviz_urdf.joints").moving_joints
    if name in ("load_file", "load_robot"):
        return getattr(importlib.import_module("webviz_urdf.load"), name)
    raise AttributeError(f"module 'webviz_urdf' has no attribute {name!r}")
