"""Triangle meshes of a box, sphere, cylinder, cone and square, of size 1 around the origin.

Browsers average normals at shared vertices, so sharp edges have separate vertices for each side.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray


class Solid(NamedTuple):
    """A triangle mesh.

    Attributes:
        vertices: float32 (V, 3).
        faces: uint32 (F, 3), counter-clockwise from outside.
    """

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]


def _turned(profile: ArrayLike, corners: int) -> Solid:
    """Return a smooth solid of revolution about z.

    Args:
        profile: (radius, z) of its points, from bottom to top.
        corners: of its cross-section.
    """
    radius, z = np.asarray(profile, dtype=np.float64).T
    angle = np.arange(corners) * (2.0 * np.pi / corners)
    around = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    rings = np.concatenate(
        (radius[:, None, None] * around, np.broadcast_to(z[:, None, None], (len(z), corners, 1))),
        axis=2,
    )
    here = np.arange((len(z) - 1) * corners).reshape(-1, corners)
    right = np.roll(here, -1, axis=1)
    lower = np.stack((here, right, right + corners), axis=-1)
    upper = np.stack((here, right + corners, here + corners), axis=-1)
    faces = np.concatenate((lower.reshape(-1, 3), upper.reshape(-1, 3)))
    return Solid(rings.reshape(-1, 3).astype(np.float32), faces.astype(np.uint32))


def _joined(*parts: Solid) -> Solid:
    first = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])]).astype(np.uint32)
    return Solid(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + n for part, n in zip(parts, first, strict=True)]),
    )


def _box() -> Solid:
    sides = []
    for axis in range(3):
        for sign in (-0.5, 0.5):
            side = np.full((4, 3), sign, np.float32)
            # Along these two axes the corners run counter-clockwise from outside.
            side[:, (axis + 1) % 3] = np.array((-1, 1, 1, -1)) * sign
            side[:, (axis + 2) % 3] = (-0.5, -0.5, 0.5, 0.5)
            sides.append(Solid(side, np.array(((0, 1, 2), (0, 2, 3)), np.uint32)))
    return _joined(*sides)


def _square() -> Solid:
    """Seen from above and from below."""
    corners = np.array(((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)), np.float32)
    corners *= np.float32(0.5)
    faces = np.array(((0, 1, 2), (0, 2, 3)), np.uint32)
    return _joined(Solid(corners, faces), Solid(corners, faces[:, ::-1]))


def _sphere(rings: int, corners: int) -> Solid:
    polar = np.linspace(0.0, np.pi, rings + 1)
    return _turned(0.5 * np.stack((np.sin(polar), -np.cos(polar)), axis=1), corners)


def _edged(profile: Sequence[tuple[float, float]], corners: int) -> Solid:
    """Like `_turned`, with a sharp edge at each point."""
    return _joined(*(_turned(profile[i : i + 2], corners) for i in range(len(profile) - 1)))


SOLIDS = {
    "box": _box(),
    "sphere": _sphere(8, 16),
    "cylinder": _edged(((0.0, -0.5), (0.5, -0.5), (0.5, 0.5), (0.0, 0.5)), 20),
    "cone": _edged(((0.0, -0.5), (0.5, -0.5), (0.0, 0.5)), 20),
    "square": _square(),
}
