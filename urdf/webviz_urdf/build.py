"""From a parsed description to a robot: reads the meshes and dresses them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import yourdfpy

from webviz.nodes import Glb, Mesh
from webviz_urdf import primitives
from webviz_urdf.description import Description, pose_of
from webviz_urdf.dress import Dresser
from webviz_urdf.glb import Part
from webviz_urdf.materials import DEFAULT, Material, Materials
from webviz_urdf.meshes import MeshError, MeshLibrary, Scale
from webviz_urdf.resolve import ResolveError, Resolver
from webviz_urdf.robot import Inertial, Link, Missing, Robot, Shape

Progress = Callable[[int, int, str], None]
"""Called with the number of shapes done, their total, and the name of the link at work."""


def build_robot(
    description: Description, resolver: Resolver, progress: Progress | None, collisions: bool
) -> Robot:
    """Read every mesh that the description names; what fails is listed in `Robot.missing`."""
    return _Builder(description, resolver, progress, collisions).build()


class _Builder:
    def __init__(
        self,
        description: Description,
        resolver: Resolver,
        progress: Progress | None,
        collisions: bool,
    ) -> None:
        self._description = description
        self._collisions = collisions
        self._materials = Materials(description.model)
        self._dresser = Dresser(resolver)
        self._resolver = resolver
        self._library = MeshLibrary(resolver)
        self._nodes: dict[tuple[object, Material], Mesh | Glb] = {}
        self._missing = [m for m in description.missing if collisions or m.kind == "visual"]
        self._warnings: dict[str, None] = {}
        self._progress = progress or (lambda done, total, link: None)
        self._done = 0
        self._total = sum(
            len(link.visuals) + (len(link.collisions) if collisions else 0)
            for link in description.model.links
        )

    def build(self) -> Robot:
        description = self._description
        links = {link.name: self._link(link) for link in description.model.links}
        self._progress(self._done, self._total, description.root)
        warnings = (
            *description.warnings,
            *self._materials.warnings,
            *self._dresser.warnings,
            *self._warnings,
        )
        return Robot(
            description.model.name,
            description.root,
            links,
            description.joints,
            tuple(self._missing),
            tuple(dict.fromkeys(warnings)),
        )

    def _link(self, link: yourdfpy.Link) -> Link:
        visuals = [(visual, self._materials.of(visual, link.name)) for visual in link.visuals]
        collisions = link.collisions if self._collisions else []
        worn = self._materials.of_collisions(link)
        return Link(
            link.name,
            self._shapes(link.name, "visual", visuals),
            self._shapes(link.name, "collision", [(c, worn) for c in collisions]),
            _inertial(link.inertial),
        )

    def _shapes(
        self,
        link: str,
        kind: str,
        elements: Sequence[tuple[yourdfpy.Visual | yourdfpy.Collision, Material]],
    ) -> tuple[Shape, ...]:
        shapes: dict[str, Shape] = {}
        for index, (element, material) in enumerate(elements):
            self._progress(self._done, self._total, link)
            self._done += 1
            name = element.name or f"{kind}_{index}"
            while name in shapes:
                name = f"{name}_{index}"
            geometry = element.geometry or yourdfpy.Geometry()
            try:
                node = self._node(geometry, material)
            except (ResolveError, MeshError) as error:
                uri = geometry.mesh.filename if geometry.mesh is not None else ""
                self._missing.append(Missing(link, uri, str(error), kind))
                continue
            shapes[name] = Shape(name, pose_of(element.origin), node)
        return tuple(shapes.values())

    def _node(self, geometry: yourdfpy.Geometry, material: Material) -> Mesh | Glb:
        """The node of a geometry; one object for all that look alike."""
        if geometry.mesh is None:
            return self._dresser.dress((_primitive(geometry),), material)
        path = self._resolver.resolve(geometry.mesh.filename)
        file = self._library.load(path, _scale(geometry.mesh.scale))
        self._warnings.update(dict.fromkeys(file.warnings))
        brings_its_own = all(part.surface for part in file.parts)
        key = (id(file), DEFAULT if brings_its_own else material)
        if key not in self._nodes:
            self._nodes[key] = self._dresser.dress(file.parts, material)
        return self._nodes[key]


def _primitive(geometry: yourdfpy.Geometry) -> Part:
    if geometry.box is not None:
        size = [float(v) for v in geometry.box.size]
        make = primitives.box
    elif geometry.cylinder is not None:
        size = [geometry.cylinder.radius, geometry.cylinder.length]
        make = primitives.cylinder
    elif geometry.sphere is not None:
        size = [geometry.sphere.radius]
        make = primitives.sphere
    else:
        raise MeshError("Its geometry is empty.")
    if min(size) < 0.0:
        raise MeshError(f"Its {make.__name__} has a negative size.")
    return make(*size)


def _scale(scale: object) -> Scale:
    """yourdfpy gives None, one float, or float64 (3,)."""
    x, y, z = np.broadcast_to(1.0 if scale is None else np.asarray(scale, float), 3).tolist()
    return x, y, z


def _inertial(inertial: yourdfpy.Inertial | None) -> Inertial | None:
    if inertial is None:
        return None
    inertia = np.zeros((3, 3)) if inertial.inertia is None else inertial.inertia
    return Inertial(float(inertial.mass or 0.0), pose_of(inertial.origin), inertia)
