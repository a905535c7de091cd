"""Nodes on the links of a loaded robot, as the user chose them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Annotated

import msgspec
import numpy as np

from webviz import Arrows, Axes, Glb, Mesh, Node, Pose, Prop, Rgb
from webviz_displays.robot_model.statuses import has_axis
from webviz_displays.shared.colors import Alpha
from webviz_urdf import Joint, Link, Robot, RobotShape, glb_with, inertia_box, mass_sphere

OPAQUE = 0.9998
"""An alpha from here on counts as 1, as in RViz."""

GREY = (150, 150, 150)

AXIS_COLOR, AXIS_LENGTH = (0, 204, 0), 0.2
"""RViz's arrow along the axis of a joint: a shaft of 0.15 m and a head of 0.05 m."""

_ORIGIN = Pose()
# RViz's link axes are 0.1 m long and 0.01 m thick.
_AXES = Axes(np.zeros((1, 3), np.float32), np.array(((1, 0, 0, 0),), np.float32), 0.1, 0.005)


class LinkSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Settings of one link."""

    enabled: Annotated[bool, Prop(help="Draw this link.")] = True
    alpha: Annotated[Alpha, Prop(help="Opacity of the link, multiplied by that of the robot.")] = (
        1.0
    )
    show_trail: Annotated[bool, Prop(help="Draw the link's last 2 m of travel.")] = False
    show_axes: Annotated[
        bool, Prop(help="Draw the axes of the link's frame and report its pose.")
    ] = False


class JointSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Settings of one joint."""

    show_axes: Annotated[
        bool, Prop(help="Draw the axes of the joint's frame at position 0 and report how it moves.")
    ] = False
    show_joint_axis: Annotated[
        bool, Prop(help="Draw an arrow along the axis the joint moves along or about.")
    ] = False


class Choices(msgspec.Struct, frozen=True):
    """Settings of a robot.

    Args:
        visual, collision, mass, inertia: what to draw of each link.
        alpha: opacity of visual and collision shapes.
        links: by name; they override `all_links`.
        joints: by name.
        all_links: whether to draw the links that have no settings.
    """

    visual: bool
    collision: bool
    mass: bool
    inertia: bool
    alpha: float
    links: Mapping[str, LinkSettings]
    joints: Mapping[str, JointSettings]
    all_links: bool

    def of(self, link: str) -> LinkSettings:
        """Return the settings of a link."""
        return self.links.get(link) or LinkSettings(enabled=self.all_links)


class LinkNode(msgspec.Struct, frozen=True, eq=False):
    """A node on a link.

    Args:
        link: name of the link.
        key: unique in the robot.
        pose: of the node in the link's frame.
        node: its look while the link has a transform.
    """

    link: str
    key: str
    pose: Pose
    node: Node


class Paint:
    """Cache of shapes with another opacity or colour: a model can hold megabytes."""

    def __init__(self) -> None:
        self._nodes: dict[tuple[int, float, Rgb | None], tuple[Node, Node]] = {}
        self._before: dict[tuple[int, float, Rgb | None], tuple[Node, Node]] = {}

    def begin(self) -> None:
        """Start a round: shapes not used until the next call are dropped then."""
        self._before, self._nodes = self._nodes, {}

    def __call__(self, node: Node, alpha: float = 1.0, color: Rgb | None = None) -> Node:
        """`node` with its opacity multiplied by `alpha`, and optionally in another colour."""
        alpha = 1.0 if alpha >= OPAQUE else alpha
        if (alpha == 1.0 and color is None) or not isinstance(node, Mesh | Glb):
            return node
        key = (id(node), alpha, color)
        # The unpainted node is held too, so that its id is not reused.
        entry = (
            self._nodes.get(key) or self._before.get(key) or (node, _painted(node, alpha, color))
        )
        self._nodes[key] = entry
        return entry[1]


def parts_of(
    visuals: Robot, collisions: Robot | None, choices: Choices, paint: Paint
) -> list[LinkNode]:
    """Everything to draw.

    Args:
        visuals: the robot.
        collisions: the same with its collision shapes; None until they are loaded.
        choices: the user's.
        paint: makes the shapes transparent.
    """
    parts = []
    for name, link in visuals.links.items():
        settings = choices.of(name)
        if not settings.enabled:
            continue
        collision = collisions.links[name] if collisions and choices.collision else None
        shapes = list(_shapes(link, collision, choices))
        alpha = choices.alpha * settings.alpha
        if alpha > 0.0:
            parts += [
                LinkNode(name, f"{name} {key}", shape.pose, paint(shape.node, alpha))
                for key, shape in shapes
            ]
        parts += [
            LinkNode(name, f"{name} {key}", _ORIGIN, node)
            for key, node in _extras(link, settings, choices)
        ]
    return parts + [
        LinkNode(joint.parent, f"{joint.name} {key}", joint.origin, node)
        for name, settings in choices.joints.items()
        if (joint := visuals.joints.get(name))
        for key, node in _joint_marks(joint, settings)
    ]


def _shapes(
    link: Link, collision: Link | None, choices: Choices
) -> Iterator[tuple[str, RobotShape]]:
    if choices.visual:
        yield from ((f"visual {shape.name}", shape) for shape in link.visuals)
    if collision is not None:
        yield from ((f"collision {shape.name}", shape) for shape in collision.collisions)


def _extras(link: Link, settings: LinkSettings, choices: Choices) -> Iterator[tuple[str, Node]]:
    if settings.show_axes:
        yield "axes", _AXES
    if choices.mass and (ball := mass_sphere(link)):
        yield "mass", ball
    if choices.inertia and (box := inertia_box(link)):
        yield "inertia", box


def _joint_marks(joint: Joint, settings: JointSettings) -> Iterator[tuple[str, Node]]:
    if settings.show_axes:
        yield "joint axes", _AXES
    if settings.show_joint_axis and has_axis(joint):
        segment = np.array([((0, 0, 0), joint.axis)], np.float32) * AXIS_LENGTH
        yield "joint axis", Arrows(segment, AXIS_COLOR, 0.025, 0.04, 0.05)


def _painted(node: Mesh | Glb, alpha: float, color: Rgb | None) -> Mesh | Glb:
    if isinstance(node, Glb):
        return Glb(glb_with(node.data, alpha, color))
    return replace(node, opacity=node.opacity * alpha, color=color or node.color)
