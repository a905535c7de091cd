"""Links and joints of a checked URDF document; the joints must form a tree."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass

import yourdfpy
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]
from trimesh.transformations import quaternion_from_matrix

from webviz.api.nodes import Pose
from webviz.data.words import listed
from webviz_urdf.document import parse_document
from webviz_urdf.robot import JOINT_TYPES, Joint, Mimic, MissingShape, RobotDescriptionError


@dataclass(frozen=True)
class Description:
    """A description before any mesh is read.

    Args:
        model: yourdfpy's links, with visuals, collisions and inertials, and materials.
        joints: by name.
        root: the link without a parent.
        missing: visuals and collisions without a geometry, which are not in `model`.
        warnings: sentences about tolerated faults.
    """

    model: yourdfpy.Robot
    joints: dict[str, Joint]
    root: str
    missing: list[MissingShape]
    warnings: list[str]


def parse_description(text: str) -> Description:
    """Parse URDF text.

    Raises:
        RobotDescriptionError: the text is not a robot, or its joints do not form one tree.
    """
    document = parse_document(text)
    xml = etree.tostring(document.root)
    urdf = yourdfpy.URDF.load(io.BytesIO(xml), build_scene_graph=False, load_meshes=False)
    model = urdf.robot
    links = _unique("link", [link.name for link in model.links])
    _unique("joint", [joint.name for joint in model.joints])
    joints = {joint.name: _joint(joint) for joint in model.joints}
    root = _root(links, joints)
    warnings = document.warnings + _broken_mimics(model.joints)
    return Description(model, joints, root, document.missing, warnings)


def pose_of(origin: object) -> Pose:
    """Pose of yourdfpy's float64 (4, 4) origin; None, a missing element, is the identity."""
    if origin is None:
        return Pose()
    matrix = origin
    x, y, z = (float(v) for v in matrix[:3, 3])  # pyright: ignore[reportIndexIssue]
    w, i, j, k = (float(v) for v in quaternion_from_matrix(matrix))
    return Pose((x, y, z), (w, i, j, k))


def _unique(kind: str, names: list[str]) -> set[str]:
    names_seen: set[str] = set()
    for name in names:
        if name in names_seen:
            raise RobotDescriptionError(f"Two {kind}s are named '{name}'.")
        names_seen.add(name)
    return names_seen


def _joint(joint: yourdfpy.Joint) -> Joint:
    if joint.type not in JOINT_TYPES:
        raise RobotDescriptionError(
            f"Joint '{joint.name}' has the unknown type '{joint.type}': "
            f"expected one of {', '.join(JOINT_TYPES)}."
        )
    x, y, z = (float(v) for v in joint.axis)  # pyright: ignore[reportOptionalIterable]
    length = math.hypot(x, y, z) or 1.0
    limit = joint.limit if joint.type in ("revolute", "prismatic") else None
    return Joint(
        name=joint.name,
        type=joint.type,
        parent=joint.parent,
        child=joint.child,
        origin=pose_of(joint.origin),
        axis=(x / length, y / length, z / length),
        # As in urdfdom a missing bound is 0.
        limits=limit and (limit.lower or 0.0, limit.upper or 0.0),
        mimic=joint.mimic and _mimic(joint.mimic),
    )


def _mimic(mimic: yourdfpy.Mimic) -> Mimic:
    # As in urdfdom a missing multiplier is 1, and a missing offset 0.
    multiplier = 1.0 if mimic.multiplier is None else float(mimic.multiplier)
    return Mimic(mimic.joint, multiplier, float(mimic.offset or 0.0))


def _root(links: set[str], joints: dict[str, Joint]) -> str:
    """Return the one link from which the joints reach all others."""
    parent_joint: dict[str, Joint] = {}
    for joint in joints.values():
        for role, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in links:
                raise RobotDescriptionError(
                    f"Joint '{joint.name}' has the {role} '{link}', which is not a link."
                )
        if joint.child in parent_joint:
            raise RobotDescriptionError(
                f"Link '{joint.child}' is the child of two joints, "
                f"'{parent_joint[joint.child].name}' and '{joint.name}'."
            )
        parent_joint[joint.child] = joint
    roots = sorted(links - parent_joint.keys())
    if len(roots) > 1:
        raise RobotDescriptionError(
            f"The links do not form one tree: {_listed(roots)} have no parent joint."
        )
    hanging: set[str] = set(roots)
    for link in links:
        path = []
        while link not in hanging:
            if link in path:
                loop = sorted(path[path.index(link) :])
                raise RobotDescriptionError(f"The joints form a loop through {_listed(loop)}.")
            path.append(link)
            link = parent_joint[link].parent
        hanging.update(path)
    return roots[0]


def _broken_mimics(joints: list[yourdfpy.Joint]) -> list[str]:
    """Warnings about joints that mimic a missing joint, or each other."""
    leaders = {joint.name: joint.mimic and joint.mimic.joint for joint in joints}
    warnings = []
    for name, leader in leaders.items():
        if leader and leader not in leaders:
            warnings.append(f"Joint '{name}' mimics '{leader}', which is not a joint.")
        visited = {name}
        while leader and leader not in visited:
            visited.add(leader)
            leader = leaders.get(leader)
        if leader == name:
            warnings.append(f"Joint '{name}' mimics itself, directly or through other joints.")
    return warnings


def _listed(names: list[str]) -> str:
    return listed([f"'{name}'" for name in names], 5)
