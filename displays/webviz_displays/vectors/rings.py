"""Torques as RViz draws those of joints: rings about an axis with a head."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz import Group, Pose
from webviz.data.rotations import matrices
from webviz_displays.shared.colors import RAINBOW, ramp
from webviz_displays.shared.rods import add_solid_arrows, rods

F64 = NDArray[np.float64]

LEAST_SHARE, LEAST_RADIUS = 0.05, 0.05
"""A joint without effort has a small ring; its radius in metres."""

HEAD = 2.0
"""Length and radius of a head in widths of its ring."""

_ANGLES = np.arange(30) * (2 * np.pi / 32)
_CIRCLE = np.stack((np.sin(_ANGLES), np.cos(_ANGLES), np.zeros_like(_ANGLES)), axis=1)
"""From the head at y against the direction of the torque, open before the head."""


class Rings(NamedTuple):
    """N torques to draw.

    Attributes:
        names: (N,), of the joints.
        centers: (N, 3), metres.
        axes: (N, 3), unit vectors.
        efforts: (N,), Nm about the axes.
        largest: (N,), Nm, 0 where unknown.
    """

    names: NDArray[np.object_]
    centers: F64
    axes: F64
    efforts: F64
    largest: F64

    @classmethod
    def of(
        cls,
        names: Sequence[str],
        poses: Sequence[Pose],
        axes: Sequence[Sequence[float]],
        efforts: Sequence[float],
        largest: Sequence[float],
    ) -> Rings:
        """Rings of links at poses in the fixed frame, whose axes are given in those links."""
        turns = matrices(np.array([pose.wxyz for pose in poses]).reshape(-1, 4))
        own = np.array(axes, np.float64).reshape(-1, 3)
        return cls(
            np.array(names, object),
            np.array([pose.position for pose in poses], np.float64).reshape(-1, 3),
            np.einsum("nij,nj->ni", turns, own),
            np.array(efforts, np.float64),
            np.array(largest, np.float64),
        )


def shares(efforts: F64, largest: F64) -> F64:
    """Return the sizes of rings, from 0.05 for no effort to 1.05 for the largest, as in RViz.

    Without a largest effort it is the effort itself.
    """
    known = largest > 0
    share = np.abs(efforts) / np.where(known, largest, 1.0)
    return np.where(known, np.minimum(share, 1.0), share) + LEAST_SHARE


def add_rings(group: Group, rings: Rings, width: float, scale: float, alpha: float) -> None:
    """Draw rings from magenta (no effort) to red (the largest).

    Args:
        group: where to draw.
        rings: in its coordinates.
        width: of the rings, metres.
        scale: diameter of the ring of the largest effort, metres.
        alpha: opacity.
    """
    size = shares(rings.efforts, rings.largest)
    colors = ramp(size, 0.0, 1.0, RAINBOW[::-1])
    radii = LEAST_RADIUS + size * scale / 2
    turns = matrices(rods(np.zeros_like(rings.axes), rings.axes, 0.0).wxyzs)
    sides = turns * np.where(rings.efforts < 0, -1.0, 1.0)[:, None, None] * (1.0, 0.0, 0.0)
    frames = sides + turns * (0.0, 1.0, 1.0)  # negative torques are mirrored along x
    points = np.einsum("nij,pj->npi", frames, _CIRCLE) * radii[:, None, None]
    points += rings.centers[:, None]
    segments = np.stack((points[:, :-1], points[:, 1:]), axis=2)
    count = segments.shape[1]
    shades = np.repeat(colors, 2 * count, axis=0).reshape(-1, 2, 3)
    names = np.repeat(rings.names, count)
    group.lines("rings", segments.reshape(-1, 2, 3), shades, width, "m", names, alpha)
    starts = points[:, 0]
    heads = np.stack((starts, starts - HEAD * width * frames[:, :, 0]), axis=1)
    sizes = 0.0, HEAD * width, HEAD * width
    add_solid_arrows(group, heads, colors, *sizes, alpha, rings.names)
