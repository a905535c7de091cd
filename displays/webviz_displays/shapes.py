"""Many copies of a simple mesh as one, so that a trail of them is one node."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
U32 = NDArray[np.uint32]


class Shape(NamedTuple):
    """A triangle mesh.

    Attributes:
        vertices: float64 (V, 3).
        faces: uint32 (F, 3), counter-clockwise seen from outside.
    """

    vertices: F64
    faces: U32


def copies(shape: Shape, centers: F64, frames: F64) -> tuple[NDArray[np.float32], U32]:
    """A shape drawn N times.

    Args:
        shape: around the origin.
        centers: (N, 3), where each copy's origin is.
        frames: (N, 3, 3), whose columns are the images of the shape's x, y and z.

    Returns:
        Vertices float32 (N * V, 3) and faces uint32 (N * F, 3).
    """
    placed = centers[:, None, :] + np.einsum("nij,vj->nvi", frames, shape.vertices)
    first = np.arange(len(centers), dtype=np.uint32) * np.uint32(len(shape.vertices))
    faces = first[:, None, None] + shape.faces
    return placed.reshape(-1, 3).astype(np.float32), faces.reshape(-1, 3)


def _disc(corners: int) -> Shape:
    angles = np.arange(corners) * (2 * np.pi / corners)
    rim = np.stack((np.cos(angles), np.sin(angles), np.zeros(corners)), axis=1)
    around = np.arange(corners, dtype=np.uint32)
    faces = np.stack((around, np.roll(around, -1), np.full(corners, corners)), axis=1)
    return Shape(np.concatenate((rim, np.zeros((1, 3)))), faces.astype(np.uint32))


def _sphere(rings: int, corners: int) -> Shape:
    """Rings of corners between two poles."""
    polar = np.arange(1, rings + 1) * (np.pi / (rings + 1))
    angles = np.arange(corners) * (2 * np.pi / corners)
    polar, angles = (g.ravel() for g in np.meshgrid(polar, angles, indexing="ij"))
    rim = np.sin(polar)
    body = np.stack((rim * np.cos(angles), rim * np.sin(angles), np.cos(polar)), axis=1)
    vertices = np.concatenate((body, ((0.0, 0.0, 1.0), (0.0, 0.0, -1.0))))
    here = np.arange(corners)
    right = np.roll(here, -1)
    faces = [np.stack((np.full(corners, len(body)), here, right), axis=1)]
    for ring in range(rings - 1):
        top, low = ring * corners, (ring + 1) * corners
        faces.append(np.stack((top + here, low + here, top + right), axis=1))
        faces.append(np.stack((top + right, low + here, low + right), axis=1))
    last = (rings - 1) * corners
    faces.append(np.stack((np.full(corners, len(body) + 1), last + right, last + here), axis=1))
    return Shape(vertices, np.concatenate(faces).astype(np.uint32))


DISC = _disc(24)
"""Of radius 1 in the x-y plane."""

SPHERE = _sphere(7, 16)
"""Of radius 1."""

WEDGE = Shape(
    np.array(((0.0, 0.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0))),
    np.array(((0, 1, 2),), dtype=np.uint32),
)
"""A flat triangle from the origin to x = 1, where it reaches from y = -1 to 1."""
