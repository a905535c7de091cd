"""Markers of type MESH_RESOURCE, once their meshes are loaded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from webviz import Models, Node, Shape
from webviz_displays.markers.batch import F32, MarkerBatch, opacities, rgb
from webviz_displays.markers.solids import Solids
from webviz_urdf import MeshContent, MeshPart, Surface, write_glb

Tint = tuple[float, float, float, float]
"""RGBA that the materials of a mesh are multiplied by."""
MAX_MODELS = 64_000_000
"""Bytes of the models of one mesh that are kept; a publisher may change the colour with each
message."""


@dataclass(frozen=True, eq=False)
class LoadedMesh:
    """A mesh file that was read.

    Args:
        name: unique among the meshes.
        content: of the file; while it lives, its memory is counted.
    """

    name: str
    content: MeshContent
    _models: dict[tuple[int, Tint], bytes] = field(default_factory=dict[tuple[int, Tint], bytes])

    @property
    def parts(self) -> tuple[MeshPart, ...]:
        """Parts of the mesh, at least one."""
        return self.content.parts

    @cached_property
    def whole(self) -> ColoredPiece:
        """All parts, without their materials."""
        return ColoredPiece(self.name, *_joined(self.parts))

    @cached_property
    def pieces(self) -> tuple[tuple[ColoredPiece, Surface], ...]:
        """The parts that have one colour each, with the surface that the file gives them."""
        alike: dict[Surface, list[MeshPart]] = {}
        for part in self.parts:
            if not is_colorful(part):
                alike.setdefault(part.surface or _NO_SURFACE, []).append(part)
        return tuple(
            (ColoredPiece(f"{self.name} {i}", *_joined(parts)), surface)
            for i, (surface, parts) in enumerate(alike.items())
        )

    @cached_property
    def colorful(self) -> tuple[MeshPart, ...]:
        """The parts with a texture or vertex colours."""
        return tuple(filter(is_colorful, self.parts))

    def model(self, number: int, tint: Tint) -> bytes:
        """Return a part of `colorful` in a tint, as a binary glTF."""
        key = number, tint
        if key not in self._models:
            data = write_glb([_tinted(self.colorful[number], tint)])
            size = len(data) + sum(map(len, self._models.values()))
            while self._models and size > MAX_MODELS:
                size -= len(self._models.pop(next(iter(self._models))))
            self._models[key] = data
        return self._models[key]


_NO_SURFACE = Surface()


class ColoredPiece:
    """A part of a mesh that has one colour.

    Args:
        name: unique among the pieces.
        vertices, faces: see `Shape`.
    """

    def __init__(self, name: str, vertices: F32, faces: np.ndarray) -> None:
        self.name = name
        self.shape = Shape(vertices, faces)

    @cached_property
    def mirrored(self) -> Shape:
        """The shape with its x axis reversed, for scales with a negative product."""
        flip = np.array((-1.0, 1.0, 1.0), np.float32)
        return Shape(self.shape.vertices * flip, np.ascontiguousarray(self.shape.faces[:, ::-1]))

    def solids(self, some: MarkerBatch, colors: F32) -> Iterator[Solids]:
        """One for each marker of a batch, in a colour each."""
        is_mirrored = np.prod(np.sign(some.scales), axis=1) < 0.0
        for chosen, name, sign in (
            (~is_mirrored, self.name, 1.0),
            (is_mirrored, f"-{self.name}", -1.0),
        ):
            if chosen.any():
                shape = self.shape if sign > 0.0 else self.mirrored
                scales = some.scales[chosen] * (sign, 1.0, 1.0)
                where = some.positions[chosen], some.wxyzs[chosen]
                yield Solids(
                    shape, *where, scales, colors[chosen], some.ids[chosen], mesh=f"mesh {name}"
                )


Meshes = Mapping[int, LoadedMesh]
"""Meshes by the row of the marker in its batch."""


def mesh_solids(batch: MarkerBatch, meshes: Meshes) -> Iterator[Solids]:
    """Yield solids of one colour; those from one file are drawn together."""
    for mesh, rows in _by_mesh(meshes).items():
        own = batch.own_materials[rows]
        plain = batch.only(rows[~own])
        if len(plain):
            yield from mesh.whole.solids(plain, plain.colors)
        with_own = batch.only(rows[own])
        for piece, surface in mesh.pieces if len(with_own) else ():
            if surface is _NO_SURFACE:  # such as an STL file's
                is_default = ~with_own.colors.any(axis=1, keepdims=True)
                colors = np.where(
                    is_default, np.array(_NO_SURFACE.rgba, np.float32), with_own.colors
                )
            else:
                tints = np.array([tint_of(color) for color in with_own.colors], np.float32)
                colors = np.array(surface.rgba, np.float32) * tints
            yield from piece.solids(with_own, colors)


def models_of(batch: MarkerBatch, meshes: Meshes) -> dict[str, Node]:
    """Return models for parts with a texture or vertex colours, of the meshes that are loaded."""
    nodes: dict[str, Node] = {}
    for mesh, rows in _by_mesh(meshes).items():
        with_own = rows[batch.own_materials[rows]]
        if not mesh.colorful or not len(with_own):
            continue
        by_tint: dict[Tint, list[int]] = {}
        for row in with_own.tolist():
            by_tint.setdefault(tint_of(batch.colors[row]), []).append(row)
        for tint, some in by_tint.items():
            chosen = batch.only(np.array(some))
            for number in range(len(mesh.colorful) if tint[3] > 0.0 else 0):
                nodes[f"model {mesh.name} {number} {tint}"] = Models(
                    chosen.positions.astype(np.float32),
                    chosen.wxyzs.astype(np.float32),
                    chosen.scales.astype(np.float32),
                    mesh.model(number, tint),
                    chosen.ids,
                )
    return nodes


def tint_of(color: F32) -> Tint:
    """Return the tint by a colour (4,): it multiplies the materials of a file.

    All zeros, the default, and black leave them as they are; RViz mixes the colour in by half, so
    that white, which most programs send, would wash them out.
    """
    red, green, blue = (rgb(color) / 255.0).tolist()
    alpha = float(opacities(color[3]))
    if not (red or green or blue):
        return (1.0, 1.0, 1.0, alpha or 1.0)
    return red, green, blue, alpha


def is_colorful(part: MeshPart) -> bool:
    """Return whether a part has more than one colour."""
    return part.colors is not None or bool(part.surface and part.surface.texture)


def _by_mesh(meshes: Meshes) -> dict[LoadedMesh, np.ndarray]:
    by_mesh: dict[LoadedMesh, list[int]] = {}
    for row, mesh in meshes.items():
        by_mesh.setdefault(mesh, []).append(row)
    return {mesh: np.array(rows) for mesh, rows in by_mesh.items()}


def _tinted(part: MeshPart, tint: Tint) -> MeshPart:
    surface = part.surface or _NO_SURFACE
    red, green, blue, alpha = (a * b for a, b in zip(surface.rgba, tint, strict=True))
    return replace(part, surface=replace(surface, rgba=(red, green, blue, alpha)))


def _joined(parts: Sequence[MeshPart]) -> tuple[F32, np.ndarray]:
    """Vertices and faces of several parts as one mesh."""
    first = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    faces = [part.faces + np.uint32(n) for part, n in zip(parts, first, strict=True)]
    return np.concatenate([part.vertices for part in parts]), np.concatenate(faces)
