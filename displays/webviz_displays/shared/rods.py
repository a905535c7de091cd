"""Rods and arrows as solids, which can be transparent and differ in size."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from webviz import Group, Rgb, Solid
from webviz.api.nodes import Ids

F64 = NDArray[np.float64]

_LEAST_LENGTH = 1e-12


class Rods(NamedTuple):
    """Cylinders or cones from tails to tips, for `webviz.Instances`.

    Attributes:
        positions: (N, 3), middles, metres.
        scales: (N, 3), two diameters and the length, metres.
        wxyzs: (N, 4), unit quaternions that turn z into the direction.
    """

    positions: F64
    scales: F64
    wxyzs: F64


def rods(tails: ArrayLike, tips: ArrayLike, diameters: ArrayLike) -> Rods:
    """Rods from `tails` (N, 3) to `tips` (N, 3), with one diameter each or for all."""
    tails, tips = np.asarray(tails, np.float64), np.asarray(tips, np.float64)
    ways = tips - tails
    lengths = np.linalg.norm(ways, axis=1)
    turns = from_z(ways / np.maximum(lengths, _LEAST_LENGTH)[:, None])
    return turned_rods(tails, tips, diameters, lengths, turns)


def turned_rods(tails: F64, tips: F64, diameters: ArrayLike, lengths: F64, wxyzs: F64) -> Rods:
    """Rods whose lengths (N,) and rotations of z to their directions (N, 4) are known."""
    scales = np.empty((len(lengths), 3))
    scales[:, 0] = scales[:, 1] = diameters
    scales[:, 2] = lengths
    return Rods((tails + tips) / 2, scales, wxyzs)


def from_z(directions: F64) -> F64:
    """Return the shortest rotations (N, 4) of z to vectors (N, 3) of length one or zero."""
    x, y, z = directions.T
    # It is (1 + z·d, z x d), normalised; to -z any half turn will do.
    wxyzs = np.stack((1.0 + z, -y, x, np.zeros_like(z)), axis=1)
    norms = np.linalg.norm(wxyzs, axis=1, keepdims=True)
    return np.where(norms > 1e-6, wxyzs / np.maximum(norms, 1e-6), (0.0, 1.0, 0.0, 0.0))


def add_solid_arrows(
    group: Group,
    segments: F64,
    color: Rgb | NDArray[np.uint8],
    shaft_radius: ArrayLike,
    head_radius: ArrayLike,
    head_length: ArrayLike,
    opacity: float = 1.0,
    ids: Ids | None = None,
    key: str = "",
) -> None:
    """Draw arrows as solids: those of `Group.arrows` are opaque and of one thickness.

    Args:
        group: where to draw.
        segments: (N, 2, 3), tails and tips, metres.
        color: (N, 3) or one for all.
        shaft_radius, head_radius, head_length: metres; (N,) or one for all.
        opacity: of all.
        ids: (N,), of the arrows.
        key: distinguishes several kinds of arrows in one group.
    """
    tails, tips = segments[:, 0], segments[:, 1]
    ways = tips - tails
    lengths = np.maximum(np.linalg.norm(ways, axis=1), _LEAST_LENGTH)
    heads = np.minimum(head_length, lengths)
    necks = tips - (heads / lengths)[:, None] * ways
    turns = from_z(ways / lengths[:, None])
    widths = 2 * np.asarray(shaft_radius), 2 * np.asarray(head_radius)
    kinds: tuple[tuple[str, Solid, Rods], ...] = (
        ("shafts", "cylinder", turned_rods(tails, necks, widths[0], lengths - heads, turns)),
        ("heads", "cone", turned_rods(necks, tips, widths[1], heads, turns)),
    )
    for name, shape, solids in kinds:
        group.instances(
            f"{key} {name}".lstrip(), shape, *solids[:2], color, solids.wxyzs, opacity, ids=ids
        )
