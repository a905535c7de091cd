"""Box, sphere and cylinder as triangles, with the sharp edges of the body."""

from __future__ import annotations

from functools import cache

import numpy as np

from webviz_urdf.glb import MeshPart

_SEGMENTS = 32


def box(x: float, y: float, z: float) -> MeshPart:
    """Return a box around the origin, edges in metres; each side shows a whole texture."""
    u = np.array((0.0, 1.0, 1.0, 0.0))
    v = np.array((0.0, 0.0, 1.0, 1.0))
    vertices, faces = [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            side = np.empty((4, 3))
            side[:, axis] = sign
            # Along these two axes the corners run counter-clockwise seen from outside.
            side[:, (axis + 1) % 3] = sign * (2.0 * u - 1.0)
            side[:, (axis + 2) % 3] = 2.0 * v - 1.0
            faces.append(np.array(((0, 1, 2), (0, 2, 3))) + 4 * len(vertices))
            vertices.append(side)
    corners = np.concatenate(vertices) * (x / 2.0, y / 2.0, z / 2.0)
    uvs = np.tile(np.stack((u, v), axis=1), (6, 1))
    return _part(corners, np.concatenate(faces), uvs)


def sphere(radius: float) -> MeshPart:
    """Return a sphere around the origin, metres."""
    vertices, faces = _unit_sphere()
    return _part(radius * vertices, faces)


@cache
def _unit_sphere() -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a sphere with radius 1; each link with a mass has one."""
    import trimesh  # by the process that loads robots; in a viewer only for centres of mass

    ball = trimesh.creation.icosphere(subdivisions=3)
    return np.asarray(ball.vertices), np.asarray(ball.faces, np.uint32)


def cylinder(radius: float, length: float) -> MeshPart:
    """Return a cylinder along z around the origin, metres.

    The caps have vertices of their own, so that a renderer that averages normals at shared
    vertices keeps the edge sharp and the side round.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, _SEGMENTS, endpoint=False)
    ring = np.stack((radius * np.cos(angle), radius * np.sin(angle)), axis=1)
    bottom = np.column_stack((ring, np.full(_SEGMENTS, -length / 2.0)))
    top = bottom * (1.0, 1.0, -1.0)
    i = np.arange(_SEGMENTS)
    j = np.roll(i, -1)
    n = _SEGMENTS
    fan = np.stack((np.zeros(n - 2, int), i[1:-1], i[2:]), axis=1)
    faces = np.concatenate(
        (
            np.stack((i, j, j + n), axis=1),
            np.stack((i, j + n, i + n), axis=1),
            fan[:, ::-1] + 2 * n,
            fan + 3 * n,
        )
    )
    return _part(np.concatenate((bottom, top, bottom, top)), faces)


def _part(vertices: np.ndarray, faces: np.ndarray, uvs: np.ndarray | None = None) -> MeshPart:
    # Plain arrays: viewers would import trimesh, and scipy with it, to receive one of theirs.
    return MeshPart(
        np.asarray(vertices, np.float32),
        np.asarray(faces, np.uint32),
        uvs=None if uvs is None else np.asarray(uvs, np.float32),
    )
