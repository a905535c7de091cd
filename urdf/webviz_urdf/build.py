"""From a parsed description to a robot: reads the meshes and dresses them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import yourdfpy

from webviz.nodes import Glb, Mesh
from webviz_urdf import primitives
from webviz_urdf.description import Description, pose_of
from webviz_urdf.glb import OPAQUE, Part, Surface, write_glb
from webviz_urdf.materials import Material, Materials
from webviz_urdf.meshes import MeshError, MeshLibrary, Scale
from webviz_urdf.resolve import ResolveError, Resolver
from webviz_urdf.robot import Inertial, Link, Missing, Robot, Shape
from webviz_urdf.textures import encode, mean_color, open_image

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
        self._dresser = _Dresser(resolver)
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
            if name in shapes:
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
        key = (id(file), material)
        if key not in self._nodes:
            self._nodes[key] = self._dresser.dress(file.parts, material)
        return self._nodes[key]


class _Dresser:
    """Puts URDF materials on parts that bring none of their own."""

    def __init__(self, resolver: Resolver) -> None:
        self._resolver = resolver
        self._pictures: dict[str, tuple[bytes, tuple[float, float, float]] | None] = {}
        self.warnings: list[str] = []

    def dress(self, parts: Sequence[Part], material: Material) -> Mesh | Glb:
        """One node: a `Mesh` if one colour says all, else a `Glb`."""
        dressed = [
            part if part.surface else replace(part, surface=self._surface(part, material))
            for part in parts
        ]
        first = dressed[0].surface or Surface()
        plain = first.texture is None and all(p.colors is None for p in dressed)
        if not plain or any(part.surface != first for part in dressed):
            return Glb(write_glb(dressed))
        r, g, b = (round(255.0 * v) for v in first.rgba[:3])
        opacity = first.rgba[3] if first.rgba[3] < OPAQUE else 1.0
        return Mesh(*_joined(dressed), color=(r, g, b), opacity=opacity)

    def _surface(self, part: Part, material: Material) -> Surface:
        picture = self._picture(material.texture) if material.texture else None
        if picture is None:
            return Surface(material.rgba)
        data, (r, g, b) = picture
        alpha = material.rgba[3]
        if part.uvs is None:
            return Surface((r, g, b, alpha))
        return Surface((1.0, 1.0, 1.0, alpha), data)

    def _picture(self, uri: str) -> tuple[bytes, tuple[float, float, float]] | None:
        """The picture at `uri` as glTF stores it, and its mean colour."""
        if uri not in self._pictures:
            self._pictures[uri] = None
            try:
                image = open_image(self._resolver.resolve(uri))
                self._pictures[uri] = encode(image), mean_color(image)
            except ResolveError as error:
                self.warnings.append(f"A material's texture is not drawn: {error}")
            except (OSError, ValueError) as error:
                self.warnings.append(f"The texture '{uri}' is no readable picture ({error}).")
        return self._pictures[uri]


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


def _joined(parts: Sequence[Part]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of all parts as one mesh."""
    if len(parts) == 1:
        return parts[0].vertices, parts[0].faces
    first = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    faces = [part.faces + np.uint32(n) for part, n in zip(parts, first, strict=True)]
    return np.concatenate([part.vertices for part in parts]), np.concatenate(faces)


def _inertial(inertial: yourdfpy.Inertial | None) -> Inertial | None:
    if inertial is None:
        return None
    inertia = np.zeros((3, 3)) if inertial.inertia is None else inertial.inertia
    return Inertial(float(inertial.mass or 0.0), pose_of(inertial.origin), inertia)
