"""Nodes from mesh parts and materials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from webviz.api.nodes import Glb, Mesh
from webviz_urdf.glb import OPAQUE, MeshPart, Surface, write_glb
from webviz_urdf.materials import Material
from webviz_urdf.resolve import ResolveError, Resolver
from webviz_urdf.textures import TextureError, encode, mean_color, open_image


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
