"""A robot from a parsed description, with its meshes and materials."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import yourdfpy

from webviz.api.nodes import Glb, Mesh
from webviz_urdf import primitives
from webviz_urdf.description import Description, pose_of
from webviz_urdf.glb import OPAQUE, MeshPart, Surface, write_glb
from webviz_urdf.meshes import MeshContent, MeshError, Scale, read_mesh, scaled
from webviz_urdf.resolve import ResolveError, Resolver
from webviz_urdf.robot import Inertial, Link, MissingShape, Progress, Robot, RobotShape
from webviz_urdf.textures import TextureError, encode, mean_color, open_image

Rgba = tuple[float, float, float, float]
SHADED_RED: Rgba = (1.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Material:
    """A material of URDF.

    Args:
        rgba: 0 to 1, sRGB.
        texture: URI of an image, "" without one.
        warning: a sentence about a fault of the material, "" without one.
    """

    rgba: Rgba = SHADED_RED
    texture: str = ""
    warning: str = field(default="", compare=False)


DEFAULT = Material()


class Materials:
    """The materials of a robot by name.

    Args:
        model: the robot; its links in the order of the text.
    """

    def __init__(self, model: yourdfpy.Robot) -> None:
        self._by_name: dict[str, Material] = {}
        self._conflicting: set[str] = set()
        self.warnings: list[str] = []
        for material in model.materials:
            self._define(material, "the robot")
        for link in model.links:
            for visual in link.visuals:
                self._define(visual.material, f"link '{link.name}'")

    def of(self, visual: yourdfpy.Visual, link: str) -> Material:
        """Return the material of a visual of the link named `link`."""
        material = visual.material
        if material is None:
            return DEFAULT
        if material.name in self._by_name:
            return self._by_name[material.name]
        return _definition(material) or Material(
            warning=f"Material '{material.name or ''}' of link '{link}' is not defined. The "
            "default red is used."
        )

    def of_collisions(self, link: yourdfpy.Link) -> Material:
        """Return the material of a link's collisions: in RViz that of its first visual."""
        return self.of(link.visuals[0], link.name) if link.visuals else DEFAULT

    def _define(self, material: yourdfpy.Material | None, where: str) -> None:
        definition = material and _definition(material)
        if material is None or definition is None or not material.name:
            return
        former = self._by_name.setdefault(material.name, definition)
        if former != definition and material.name not in self._conflicting:
            self._conflicting.add(material.name)
            self.warnings.append(
                f"Material '{material.name}' is redefined differently in {where}; "
                "the first definition is used."
            )


def _definition(material: yourdfpy.Material) -> Material | None:
    """Return the content of a material, None if it is only a name."""
    texture = (material.texture and material.texture.filename) or ""
    if material.color is not None:
        r, g, b, a = (min(max(float(v), 0.0), 1.0) for v in material.color.rgba)
        return Material((r, g, b, a), texture)
    return Material((1.0, 1.0, 1.0, 1.0), texture) if texture else None


class MaterialApplier:
    """Applies URDF materials to parts without a material of their own.

    Args:
        resolver: finds the textures that materials name.
    """

    def __init__(self, resolver: Resolver) -> None:
        self._resolver = resolver
        self._pictures: dict[str, tuple[bytes, tuple[float, float, float]] | None] = {}
        self.warnings: list[str] = []

    def apply(self, parts: Sequence[MeshPart], material: Material) -> Mesh | Glb:
        """One node: a `Mesh` if one colour is enough, else a `Glb`."""
        painted = [
            part if part.surface else replace(part, surface=self._surface(part, material))
            for part in parts
        ]
        first = painted[0].surface or Surface()
        plain = first.texture is None and all(p.colors is None for p in painted)
        if not plain or any(part.surface != first for part in painted):
            return Glb(write_glb(painted))
        r, g, b = (round(255.0 * v) for v in first.rgba[:3])
        opacity = first.rgba[3] if first.rgba[3] < OPAQUE else 1.0
        return Mesh(*_joined(painted), color=(r, g, b), opacity=opacity)

    def _surface(self, part: MeshPart, material: Material) -> Surface:
        picture = self._picture(material.texture) if material.texture else None
        if picture is None:
            return Surface(material.rgba)
        data, (r, g, b) = picture
        alpha = material.rgba[3]
        if part.uvs is None:
            return Surface((r, g, b, alpha))
        return Surface((1.0, 1.0, 1.0, alpha), data)

    def _picture(self, uri: str) -> tuple[bytes, tuple[float, float, float]] | None:
        """Return the picture at `uri` as glTF stores it, and its mean colour."""
        if uri not in self._pictures:
            self._pictures[uri] = None
            try:
                image = open_image(self._resolver.resolve(uri))
                self._pictures[uri] = encode(image), mean_color(image)
            except (ResolveError, TextureError) as error:
                self.warnings.append(f"A material's texture is not drawn. {error}")
        return self._pictures[uri]


def _joined(parts: Sequence[MeshPart]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of all parts as one mesh."""
    if len(parts) == 1:
        return parts[0].vertices, parts[0].faces
    first = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    faces = [part.faces + np.uint32(n) for part, n in zip(parts, first, strict=True)]
    return np.concatenate([part.vertices for part in parts]), np.concatenate(faces)


MAX_BYTES = 100 << 20
"""Limit in bytes of all shapes of a robot; every browser receives them."""

MAX_SHAPES = 10_000


def build_robot(
    description: Description,
    resolver: Resolver,
    progress: Progress | None,
    collisions: bool,
    skip: Mapping[int, str],
) -> Robot:
    """Read every mesh of a description; failures are listed in `Robot.missing`."""
    return _Builder(description, resolver, progress, collisions, skip).build()


class _Builder:
    def __init__(
        self,
        description: Description,
        resolver: Resolver,
        progress: Progress | None,
        collisions: bool,
        skip: Mapping[int, str],
    ) -> None:
        self._description = description
        self._collisions = collisions
        self._materials = Materials(description.model)
        self._applier = MaterialApplier(resolver)
        self._resolver = resolver
        self._files: dict[Path, MeshContent] = {}
        self._nodes: dict[tuple[Path, Scale, Material], Mesh | Glb] = {}
        self._missing = [m for m in description.missing if collisions or m.kind == "visual"]
        self._warnings: dict[str, None] = {}
        self._progress = progress or (lambda done, total, link: None)
        self._skip = skip
        self._refused: dict[str, str] = {}
        self._bytes = 0
        self._progress_count = 0
        self._total = sum(
            len(link.visuals) + (len(link.collisions) if collisions else 0)
            for link in description.model.links
        )

    def build(self) -> Robot:
        description = self._description
        links = {link.name: self._link(link) for link in description.model.links}
        self._progress(self._progress_count, self._total, description.root)
        warnings = (
            *description.warnings,
            *self._materials.warnings,
            *self._applier.warnings,
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
        material = self._materials.of_collisions(link)
        return Link(
            link.name,
            self._shapes(link.name, "visual", visuals),
            self._shapes(link.name, "collision", [(c, material) for c in collisions]),
            _inertial(link.inertial),
        )

    def _shapes(
        self,
        link: str,
        kind: str,
        elements: Sequence[tuple[yourdfpy.Visual | yourdfpy.Collision, Material]],
    ) -> tuple[RobotShape, ...]:
        shapes: dict[str, RobotShape] = {}
        for index, (element, material) in enumerate(elements):
            number = self._progress_count
            self._progress(number, self._total, link)
            self._progress_count += 1
            name = element.name or f"{kind}_{index}"
            while name in shapes:
                name = f"{name}_{index}"
            geometry = element.geometry or yourdfpy.Geometry()
            uri = geometry.mesh.filename if geometry.mesh is not None else ""
            try:
                self._check(number, uri)
                node = self._node(geometry, material)
                self._count(node)
            except (ResolveError, MeshError) as error:
                self._missing.append(MissingShape(link, uri, str(error), kind))
                continue
            shapes[name] = RobotShape(name, pose_of(element.origin), node, uri)
        return tuple(shapes.values())

    def _check(self, number: int, uri: str) -> None:
        """Raise if a shape is to be skipped, or has the mesh of one that was."""
        reason = self._skip.get(number) or self._refused.get(uri)
        if reason is not None:
            if uri:
                self._refused[uri] = reason
            raise MeshError(f"{uri or 'The shape'} is skipped. {reason}")
        if number >= MAX_SHAPES:
            raise MeshError(f"The robot has more than {MAX_SHAPES} shapes.")

    def _count(self, node: Mesh | Glb) -> None:
        """Add the size of a node; raise if the robot becomes too large."""
        size = len(node.data) if isinstance(node, Glb) else node.vertices.nbytes + node.faces.nbytes
        if self._bytes + size > MAX_BYTES:
            raise MeshError(
                f"With this shape the robot has more than {MAX_BYTES >> 20} MB of triangles and "
                "textures. Simplify its meshes."
            )
        self._bytes += size

    def _node(self, geometry: yourdfpy.Geometry, material: Material) -> Mesh | Glb:
        """Return the node of a geometry; equal ones share one object."""
        if geometry.mesh is None:
            part = _primitive(geometry)
            self._warn(material.warning)
            return self._applier.apply((part,), material)
        path, scale = self._resolver.resolve(geometry.mesh.filename), _scale(geometry.mesh.scale)
        if path not in self._files:
            self._files[path] = read_mesh(path, self._resolver)
        file = self._files[path]
        if all(part.surface for part in file.parts):
            material = DEFAULT  # the file has materials of its own
        self._warn(*file.warnings, material.warning)
        key = (path, scale, material)
        if key not in self._nodes:
            parts = [scaled(part, scale) for part in file.parts]
            self._nodes[key] = self._applier.apply(parts, material)
        return self._nodes[key]

    def _warn(self, *sentences: str) -> None:
        self._warnings.update(dict.fromkeys(filter(None, sentences)))


def _primitive(geometry: yourdfpy.Geometry) -> MeshPart:
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
