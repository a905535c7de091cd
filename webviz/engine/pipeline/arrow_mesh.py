"""Arrows as one mesh: viser's arrows cannot be transparent."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Arrows, Mesh

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
