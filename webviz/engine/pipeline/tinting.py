"""Another look of all that displays draw, so that a second run cannot be taken for the first."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import (
    Arrows,
    Axes,
    Glb,
    Image,
    Instances,
    Labels,
    Lines,
    Mesh,
    Models,
    Node,
    Pane,
    Points,
    Rgb,
)
from webviz.data.gltf import pack, unpack
from webviz.data.rotations import matrices

SIDES = 8
RINGS = 3
"""Around the tail, and inside and outside of where the head begins; the tip comes after them."""


def arrow_mesh(arrows: Arrows, rgba: NDArray[np.uint8]) -> Mesh:
    """Return arrows as a mesh, whose faces are selected by the ids of the arrows.

    Args:
        arrows: N of them; those that are not finite are left out.
        rgba: uint8 (N, 4).
    """
    ids = np.arange(len(rgba)) if arrows.ids is None else arrows.ids
    rows = np.flatnonzero(np.isfinite(arrows.segments).all(axis=(1, 2)))
    tails, tips = arrows.segments[rows].astype(np.float64).swapaxes(0, 1)
    ways = tips - tails
    lengths = np.linalg.norm(ways, axis=1, keepdims=True)
    along = np.divide(
        ways, lengths, out=np.tile([1.0, 0.0, 0.0], (len(ways), 1)), where=lengths > 0
    )
    necks = tips - along * np.minimum(arrows.head_length, lengths)
    rings = _circles(along)
    inner, outer = arrows.shaft_radius * rings, arrows.head_radius * rings
    corners = (tails[:, None] + inner, necks[:, None] + inner, necks[:, None] + outer)
    vertices = np.concatenate((*corners, tips[:, None]), axis=1)
    count, each = vertices.shape[:2]
    faces = _FACES + each * np.arange(count)[:, None, None]
    return Mesh(
        vertices.reshape(-1, 3).astype(np.float32),
        faces.reshape(-1, 3).astype(np.uint32),
        color=(255, 255, 255),
        ids=np.repeat(ids[rows], len(_FACES)),
        colors=np.repeat(rgba[rows], each, axis=0),
    )


def _circles(along: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points of a circle around each direction, (N, SIDES, 3), of radius 1."""
    least = np.eye(3)[np.abs(along).argmin(axis=1)]
    left = np.cross(along, least)
    left /= np.linalg.norm(left, axis=1, keepdims=True)
    up = np.cross(along, left)
    angles = np.linspace(0.0, 2 * np.pi, SIDES, endpoint=False)[:, None]
    return np.cos(angles) * left[:, None] + np.sin(angles) * up[:, None]


def _faces() -> NDArray[np.int64]:
    """Return the faces of one arrow, counter-clockwise seen from outside."""
    here = np.arange(SIDES)
    there = (here + 1) % SIDES
    tail, neck, rim = (ring * SIDES for ring in range(RINGS))
    tip = np.full(SIDES, RINGS * SIDES)

    def between(lower: int, upper: int) -> list[NDArray[np.int64]]:
        first = np.stack((lower + here, lower + there, upper + there), axis=1)
        return [first, np.stack((lower + here, upper + there, upper + here), axis=1)]

    end = np.stack((np.zeros(SIDES - 2, int), here[2:], here[1:-1]), axis=1)
    head = np.stack((rim + here, rim + there, tip), axis=1)
    return np.concatenate([end, *between(tail, neck), *between(neck, rim), head])


_FACES = _faces()


SHARE = 0.8
"""Share of the tint in each colour: the rest still tells apart what has several."""
AXIS_COLORS = np.diag([255, 255, 255]).astype(np.uint8)
GREY: Rgb = (128, 128, 128)
GAMMA = 2.2
"""Exponent of sRGB, about."""


class Tint(msgspec.Struct, frozen=True):
    """Mixes a colour into nodes and makes them transparent.

    Args:
        color: that is mixed in; None for none.
        opacity: 0 to 1, multiplies that of each node.
    """

    color: Rgb | None
    opacity: float

    def __call__(self, node: Node) -> Node:
        """Return a node with the other look; panes are outside the scene, and stay."""
        match node:
            case Points() | Lines():
                own = GREY if self.color and node.colors is None else node.colors
                colors = None if own is None else self._mixed(own)
                return replace(node, colors=colors, opacity=node.opacity * self.opacity)
            case Arrows():
                return self._arrows(node)
            case Axes():
                return self._lines(node)
            case Labels():
                colors = node.colors if self.color is None else self.color
                return replace(node, colors=colors, opacity=node.opacity * self.opacity)
            case Mesh():
                own = None if node.colors is None else self._faded(node.colors)
                color, opacity = self._one(node.color), node.opacity * self.opacity
                return replace(node, color=color, opacity=opacity, colors=own)
            case Instances():
                opacity = np.multiply(node.opacity, self.opacity, dtype=np.float32)
                return replace(
                    node,
                    colors=self._mixed(node.colors),
                    opacity=opacity if opacity.ndim else float(opacity),
                )
            case Models() | Glb():
                return replace(node, data=self._model(node.data))
            case Image(palette=None):
                return replace(node, cells=self._faded(node.cells))
            case Image():
                return replace(node, palette=self._faded(np.asarray(node.palette)))
            case Pane():
                return node

    def _mixed(self, colors: NDArray[np.uint8] | Rgb) -> NDArray[np.uint8] | Rgb:
        if isinstance(colors, tuple):
            return self._one(colors)
        if self.color is None:
            return colors
        mixed = (1 - SHARE) * colors.astype(np.float32) + SHARE * np.array(self.color, np.float32)
        return mixed.astype(np.uint8)

    def _one(self, color: Rgb) -> Rgb:
        if self.color is None:
            return color
        r, g, b = (
            round((1 - SHARE) * own + SHARE * tint)
            for own, tint in zip(color, self.color, strict=True)
        )
        return r, g, b

    def _faded(self, rgba: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return colours with opacities, both with the other look."""
        faded = rgba.copy()
        faded[..., :3] = self._mixed(rgba[..., :3])
        faded[..., 3] = rgba[..., 3] * self.opacity
        return faded

    def _arrows(self, arrows: Arrows) -> Arrows | Mesh:
        colors = self._mixed(arrows.colors)
        if self.opacity == 1.0:
            return replace(arrows, colors=colors)
        rgb = np.broadcast_to(np.asarray(colors, np.uint8), (len(arrows.segments), 3))
        alpha = np.full((len(rgb), 1), round(255 * self.opacity), np.uint8)
        return arrow_mesh(arrows, np.concatenate((rgb, alpha), axis=1))

    def _lines(self, axes: Axes) -> Lines:
        """Return axes as lines: viser's have fixed colours."""
        count = len(axes.positions)
        tails = np.repeat(axes.positions[:, None, :], 3, axis=1)
        tips = tails + axes.length * matrices(axes.wxyzs).swapaxes(1, 2)
        segments = np.stack((tails, tips), axis=2).reshape(-1, 2, 3).astype(np.float32)
        ends = np.tile(np.repeat(AXIS_COLORS[:, None, :], 2, axis=1), (count, 1, 1))
        ids = np.repeat(np.arange(count) if axes.ids is None else axes.ids, 3)
        mixed = self._mixed(ends)
        assert isinstance(mixed, np.ndarray)
        return Lines(segments, mixed, 2 * axes.radius, "m", ids, self.opacity)

    def _model(self, data: bytes) -> bytes:
        """Return a binary glTF with the other look; its textures are multiplied by it."""
        try:
            document, rest = unpack(data)
        except ValueError:
            return data
        share = 0.0 if self.color is None else SHARE
        tint = [(channel / 255) ** GAMMA for channel in self.color or GREY]
        materials: list[dict[str, Any]] = document.setdefault("materials", [{}])
        for material in materials:
            surface = material.setdefault("pbrMetallicRoughness", {})
            *rgb, alpha = surface.get("baseColorFactor", (1.0, 1.0, 1.0, 1.0))
            mixed = [
                (1 - share) * own + share * other for own, other in zip(rgb, tint, strict=True)
            ]
            surface["baseColorFactor"] = [*mixed, alpha * self.opacity]
            if self.opacity < 1.0:
                material["alphaMode"] = "BLEND"
        for mesh in document.get("meshes", []):
            for primitive in mesh["primitives"]:
                primitive.setdefault("material", 0)
        return pack(document, rest)
