"""Details of a link of a robot."""

from __future__ import annotations

from webviz import Details, Frames, Pose
from webviz_urdf import Link, Robot, RobotShape

TRAIL = " trail"
"""Ends the key of a trail, after the name of its link."""


def link_details(robot: Robot, name: str, pose: Pose | None, frame: str, frames: Frames) -> Details:
    """Return a link: where it is, its mass, and what it looks like.

    Args:
        robot: that it belongs to.
        name: of the link.
        pose: in the fixed frame, None if it is unknown.
        frame: that places the link.
        frames: of this turn.
    """
    link = robot.links[name]
    values: dict[str, object] = {}
    if inertial := link.inertial:
        values["Mass"] = f"{inertial.mass:g} kg"
    if pose:
        values[f"Pose in {frames.fixed_frame}"] = pose
    if parent := frames.link(frame):
        values["Parent frame"] = parent.parent
    joint = next((each for each in robot.joints.values() if each.child == name), None)
    if joint is not None:
        values["Joint"] = {"Name": joint.name, "Type": joint.type, "Parent link": joint.parent}
    values |= _shapes("Visual", link.visuals) | _shapes("Collision", link.collisions)
    return Details(f"Link {name}", values | _inertia(link) | {"Robot": robot.name})


def _shapes(kind: str, shapes: tuple[RobotShape, ...]) -> dict[str, object]:
    sources = {shape.name: shape.source or "a box, sphere or cylinder" for shape in shapes}
    if len(sources) > 1:
        return {f"{kind} shapes": sources}
    return {kind: sources.popitem()[1]} if sources else {}


def _inertia(link: Link) -> dict[str, object]:
    if link.inertial is None:
        return {}
    rows = link.inertial.inertia
    return {
        "Centre of mass": link.inertial.com,
        "Inertia": {
            axis: f"{', '.join(f'{value:.4g}' for value in row)} kg m²"
            for axis, row in zip("xyz", rows, strict=True)
        },
    }
