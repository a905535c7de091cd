"""Many copies of a flat mesh as one, so that a trail of them is one node."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
U32 = NDArray[np.uint32]


class TriangleMesh(NamedTuple):
    """A triangle mesh.

    Attributes:
        vertices: float64 (V, 3).
        faces: uint32 (F, 3), counter-clockwise seen from outside.
    """

    vertices: F64
    faces: U32


def copies(shape: TriangleMesh, centers: F64, frames: F64) -> tuple[NDArray[np.float32], U32]:
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


WEDGE = TriangleMesh(
    np.array(((0.0, 0.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0))),
    np.array(((0, 1, 2),), dtype=np.uint32),
)
"""A flat triangle from the origin to x = 1, where it reaches from y = -1 to 1."""
