"""Drawing of collision objects: those of one kind and opacity together."""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import msgspec
import numpy as np

from webviz import Context, Details, Hit, Mesh, Node, Pose, Rgb, Solid
from webviz.api.frames import is_placeable
from webviz.data.rotations import matrices, multiply_many
from webviz.data.words import counted
from webviz_displays.markers.batch import opacities, rgb
from webviz_displays.markers.solids import Solids, instances_of
from webviz_displays.moveit.bodies import Body, Primitives, named
from webviz_displays.moveit.frames import Links, Places
from webviz_displays.moveit.scene import KnownScene, Rgba
from webviz_displays.shared.geometry import is_drawable, origin_near

MAX_MESHES = 2000
"""Objects with meshes that are drawn, as each is a node of its own."""


class ShownObject(NamedTuple):
    """An object as it is drawn.

    Attributes:
        body: the object.
        pose: in the frame of the scene.
        rgba: 0 to 1.
    """

    body: Body
    pose: Pose
    rgba: Rgba


class PlacedNodes(NamedTuple):
    """Nodes that are placed together.

    Attributes:
        key: of the group.
        pose: in the frame of the scene.
        nodes: by key.
    """

    key: str
    pose: Pose
    nodes: Mapping[str, Node]


class DrawnObjects(NamedTuple):
    """Objects as nodes.

    Attributes:
        groups: of nodes.
        owners: the objects by the keys of their nodes; a list where a node has several, by their
            ids there.
    """

    groups: Sequence[PlacedNodes]
    owners: Mapping[str, object]

    def add(self, frame: str, ctx: Context) -> None:
        """Draw them in a frame."""
        for key, pose, nodes in self.groups:
            group = ctx.follow(frame, offset=pose, key=key)
            for name, node in nodes.items():
                group.add(name, node)


def draw_objects(objects: Iterable[ShownObject], prefix: str) -> DrawnObjects:
    """Objects as nodes, whose keys begin with `prefix`: solids of one look together."""
    objects = list(objects)
    owners: dict[str, object] = {}
    groups: list[PlacedNodes] = []
    for body, pose, rgba in objects:
        if not len(body.faces) or len(owners) >= MAX_MESHES or not is_placeable(pose):
            continue
        if opacity := opacity_of(rgba):
            key = f"{prefix}mesh {body.id:.40} {zlib.crc32(body.id.encode()):08x}"
            mesh = Mesh(body.vertices, body.faces, rgb_of(rgba), opacity)
            groups.append(PlacedNodes(key, pose, {key: mesh}))
            owners[key] = body
    solids = _solids(objects)
    if solids:
        origin = np.array(origin_near(solids[0].positions))
        for each in solids:
            each.positions[:] -= origin
        x, y, z = origin.tolist()
        nodes = {prefix + kind: node for kind, node in instances_of(solids).items()}
        groups.append(PlacedNodes(f"{prefix}solids", Pose((x, y, z)), nodes))
        bodies = [body for body, _, _ in objects]
        owners |= dict.fromkeys(nodes, bodies)
    return DrawnObjects(groups, owners)


def _solids(objects: Sequence[ShownObject]) -> list[Solids]:
    """Return the solids of objects in the frame of the scene, those of one kind together."""
    some: dict[Solid, list[int]] = {}
    for number, (body, _, _) in enumerate(objects):
        for kind in body.solids:
            some.setdefault(kind, []).append(number)
    solids_list: list[Solids] = []
    for kind, numbers in some.items():
        parts = [objects[number].body.solids[kind] for number in numbers]
        local = Primitives(*map(np.concatenate, zip(*parts, strict=True)))
        rows = np.repeat(np.arange(len(parts)), [len(part.positions) for part in parts])
        origins = np.array([objects[number].pose.position for number in numbers])[rows]
        turns = np.array([objects[number].pose.wxyz for number in numbers])[rows]
        colors = np.array([objects[number].rgba for number in numbers], np.float32)[rows]
        positions = np.einsum("nij,nj->ni", matrices(turns), local.positions) + origins
        wxyzs = multiply_many(turns, local.wxyzs)
        ids = np.array(numbers)[rows]
        solids = Solids(kind, positions, wxyzs, local.scales, colors, ids)
        solids = solids.only(is_drawable(positions))
        if len(solids.positions):
            solids_list.append(solids)
    return solids_list


class HeldObjects(msgspec.Struct):
    """Objects attached to a robot.

    Args:
        places: relative to the links.
        owners: objects by the keys of nodes, see `DrawnObjects`.
        holders: links by the id of the object.
    """

    places: Places = msgspec.field(default_factory=Places)
    owners: Mapping[str, object] = msgspec.field(default_factory=dict)
    holders: dict[str, str] = msgspec.field(default_factory=dict)

    def draw(
        self, scene: KnownScene, links: Links, rgba: Rgba, frame: str, prefix: str, ctx: Context
    ) -> list[str]:
        """Draw it where the links are; the objects that have no place.

        Args:
            scene: with what is attached.
            links: poses in `frame`.
            rgba: colour of objects without one.
            frame: that places the robot.
            prefix: begins the keys of the nodes.
            ctx: receives the nodes.
        """
        self.places.update(scene, frame, links, ctx.frames)
        attached = self.places.attached(scene, links)
        self.holders = {key: scene.attached[key].link for key in attached}
        objects = [
            ShownObject(scene.attached[key].body, pose, scene.colors.get(key, rgba))
            for key, pose in attached.items()
        ]
        nodes = draw_objects(objects, f"{prefix}attached ")
        nodes.add(frame, ctx)
        self.owners = nodes.owners
        return [key for key in scene.attached if key not in attached]

    def inspect(self, hit: Hit) -> Details | None:
        """Return an object, by one of its shapes."""
        body = owner_of(hit, self.owners)
        if body is None:
            return None
        return body_details(body, {"Attached to": self.holders.get(body.id, "")})


def owner_of(hit: Hit, owners: Mapping[str, object]) -> Body | None:
    """Return the object of a shape that was selected; see `DrawnObjects`."""
    owner = owners.get(hit.key)
    if isinstance(owner, list):
        owner = owner[hit.id] if hit.id is not None and hit.id < len(owner) else None
    return owner if isinstance(owner, Body) else None


def body_details(body: Body, first: Mapping[str, object]) -> Details:
    """Return the details of an object."""
    values = dict(first)
    if body.type:
        values["Type"] = body.type
    values["Shapes"] = ", ".join(counted(n, kind) for kind, n in body.shapes.items())
    if body.subframes:
        values["Subframes"] = {name[:80]: body.subframes[name] for name in list(body.subframes)[:5]}
    return Details(f"Object {named(body.id)}", values)


def opacity_of(rgba: Rgba) -> float:
    """Return the opacity of a colour."""
    return float(opacities(rgba[3]))


def rgb_of(rgba: Rgba) -> Rgb:
    """Return a colour without its opacity."""
    red, green, blue = rgb(np.array(rgba)).tolist()
    return red, green, blue


def with_alpha(color: Rgb, alpha: float) -> Rgba:
    """Return a colour of a property with an opacity."""
    red, green, blue = color
    return red / 255.0, green / 255.0, blue / 255.0, alpha
