"""The covariances of poses as RViz draws them: ellipses and wedges, or ellipsoids and discs.

All shapes show one standard deviation (times a scale). A pose is planar if its variances of z, roll
and pitch are all zero or negative, as planar localization leaves them.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz_displays.shared.geometry import FARTHEST

F64 = NDArray[np.float64]
Mask = NDArray[np.bool_]

WIDEST = np.deg2rad(89.0)
"""Larger angles are clamped to this; the tangent of 90 degrees is infinite."""

LARGEST = FARTHEST**2
"""Square metres or square radians; larger variances reach farther than can be drawn."""

_LIFT = 1e-3
"""Metres; flat ellipses lie so high above their pose, to be seen on a map of the same height."""

_LEAST = 1e-6
"""Metres or radians; a deviation of zero would leave a shape without a direction."""

_ROUNDING = 1e-9
"""A negative eigenvalue that is smaller by this factor than the largest is zero."""


WEDGE = np.array(((0.0, 0.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0)))
"""A flat triangle from the origin to x = 1, where it extends from y = -1 to 1."""


class Covariances(NamedTuple):
    """Covariances of N poses, ready to be drawn.

    Attributes:
        matrices: (N, 6, 6), of x, y, z and the rotations about x, y, z; in m and rad.
        is_planar: (N,).
    """

    matrices: F64
    is_planar: Mask


class Placed(NamedTuple):
    """Poses of M copies of a shape.

    Attributes:
        centers: (M, 3), metres.
        frames: (M, 3, 3), whose columns are the images of the shape's x, y and z.
    """

    centers: F64
    frames: F64

    def images(self, points: F64) -> F64:
        """Return where points (P, 3) of the shape are in each copy, (M, P, 3)."""
        return self.centers[:, None] + np.einsum("nij,pj->npi", self.frames, points)


def read(covariances: F64) -> tuple[Covariances, Mask]:
    """Check covariances (N, 36) as messages have them.

    Returns:
        The covariances, and which (N,) of them have entries up to `LARGEST` and are positive
        semidefinite in the parts that are drawn. The caller skips the others.
    """
    matrices = np.reshape(covariances, (-1, 6, 6))
    finite = np.all(np.abs(matrices) <= LARGEST, axis=(1, 2))
    matrices = np.where(finite[:, None, None], matrices, 0.0)
    is_planar = np.all(matrices[:, (2, 3, 4), (2, 3, 4)] <= 0, axis=1)
    flat_ok = _is_semidefinite(matrices[:, :2, :2]) & (matrices[:, 5, 5] >= 0)
    full_ok = _is_semidefinite(matrices[:, :3, :3]) & _is_semidefinite(matrices[:, 3:, 3:])
    return Covariances(matrices, is_planar), finite & np.where(is_planar, flat_ok, full_ok)


def has_negative_variance(covariances: F64) -> Mask:
    """Return the mask (N,) of covariances (N, 36) with a variance below zero beyond rounding."""
    matrices = np.reshape(covariances, (-1, 6, 6))
    variances = np.diagonal(matrices, axis1=1, axis2=2)
    return variances.min(axis=1) < -_ROUNDING * np.abs(variances).max(axis=1)


def ellipses(covariances: Covariances, positions: F64, rotations: F64, scale: float) -> Placed:
    """Position ellipses of planar poses, for a disc of radius 1.

    Args:
        covariances: of N poses.
        positions: (N, 3), metres.
        rotations: (N, 3, 3), of the frames in which the covariances are given.
        scale: standard deviations.
    """
    chosen = covariances.is_planar
    sigmas, vectors = _deviations(covariances.matrices[chosen, :2, :2])
    frames = np.zeros((len(sigmas), 3, 3))
    frames[:, :2, :2] = vectors * _bounded(scale * sigmas)[:, None, :]
    frames[:, 2, 2] = 1.0
    rotations = rotations[chosen]
    return Placed(positions[chosen] + _LIFT * rotations[:, :, 2], rotations @ frames)


def ellipsoids(covariances: Covariances, positions: F64, rotations: F64, scale: float) -> Placed:
    """Position ellipsoids of the other poses, for a sphere of radius 1; as `ellipses`."""
    chosen = ~covariances.is_planar
    sigmas, vectors = _deviations(covariances.matrices[chosen, :3, :3])
    frames = vectors * _bounded(scale * sigmas)[:, None, :]
    return Placed(positions[chosen], rotations[chosen] @ frames)


def wedges(
    covariances: Covariances, positions: F64, rotations: F64, scale: float, offset: float
) -> Placed:
    """Yaw wedges of planar poses, for a `WEDGE`.

    Args:
        covariances: of N poses.
        positions: (N, 3), metres.
        rotations: (N, 3, 3), of the frames whose x axes the wedges follow.
        scale: standard deviations.
        offset: length of the wedges, metres.
    """
    chosen = covariances.is_planar
    half_width = _tangent(scale * np.sqrt(np.maximum(covariances.matrices[chosen, 5, 5], 0.0)))
    frames = np.zeros((len(half_width), 3, 3))
    frames[:, 0, 0] = offset
    frames[:, 1, 1] = offset * half_width
    frames[:, 2, 2] = 1.0
    rotations = rotations[chosen]
    return Placed(positions[chosen] + _LIFT * rotations[:, :, 2], rotations @ frames)


def tip_discs(
    covariances: Covariances,
    positions: F64,
    rotations: F64,
    scale: float,
    offset: float,
    axis: Literal[0, 1, 2],
) -> Placed:
    """Return where the tips of one axis of the other poses may be, for a disc of radius 1.

    A small rotation w moves the tip e of an axis by w x e, which lies in the plane of the other
    two axes u and v: by w_v along u and by -w_u along v. As `wedges`, with `axis` 0, 1 or 2.
    """
    chosen = ~covariances.is_planar
    u, v = (axis + 1) % 3, (axis + 2) % 3
    about = covariances.matrices[chosen, 3:, 3:]
    moves = np.empty((len(about), 2, 2))
    moves[:, 0, 0], moves[:, 1, 1] = about[:, v, v], about[:, u, u]
    moves[:, 0, 1] = moves[:, 1, 0] = -about[:, max(u, v), min(u, v)]
    sigmas, vectors = _deviations(moves)
    halves = vectors * (offset * _tangent(scale * sigmas))[:, None, :]
    frames = np.zeros((len(about), 3, 3))
    frames[:, (u, v), :2] = halves
    frames[:, axis, 2] = 1.0
    rotations = rotations[chosen]
    return Placed(positions[chosen] + offset * rotations[:, :, axis], rotations @ frames)


def _is_semidefinite(matrices: F64) -> Mask:
    values = np.linalg.eigvalsh(matrices)
    return values[:, 0] >= -_ROUNDING * np.abs(values).max(axis=1)


def _deviations(matrices: F64) -> tuple[F64, F64]:
    """Return standard deviations (N, k) along the principal axes, and the axes as columns."""
    variances, vectors = np.linalg.eigh(matrices)  # reads the lower triangle, as Eigen does
    return np.maximum(np.sqrt(np.maximum(variances, 0.0)), _LEAST), vectors


def _tangent(angles: F64) -> F64:
    return np.tan(np.minimum(angles, WIDEST))


def _bounded(lengths: F64) -> F64:
    return np.clip(lengths, _LEAST, FARTHEST)
