"""Vectors as RViz draws them: straight arrows, and for rotations a circle around them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz import Group, Rgb
from webviz.data.rotations import matrices
from webviz_displays.shared.rods import add_solid_arrows, rods

F64 = NDArray[np.float64]
Ids = NDArray[np.intp]

HEAD = 0.3
"""Length of a head in lengths of its shaft, so that an arrow is 1.3 times as long as its value."""

SHAFT_RADIUS, HEAD_RADIUS = 0.05, 0.1
"""Radii in widths."""

CIRCLE_RADIUS, CIRCLE_HEIGHT = 0.25, 0.5
"""Radius and height in lengths of the shaft."""

CIRCLE_LINE, CIRCLE_HEAD = 0.05, 0.1
"""Width of the circle's line, length and radius of its head; in widths of the arrow."""

_ANGLES = np.arange(4, 33) * (2 * np.pi / 32)
"""The circle leaves its first eighth open, where its head is."""

_CIRCLE = np.stack((np.cos(_ANGLES), np.sin(_ANGLES), np.zeros_like(_ANGLES)), axis=1)


class Vectors(NamedTuple):
    """N vectors to draw.

    Attributes:
        tails: (N, 3), metres.
        shafts: (N, 3), directions and lengths of the shafts in metres.
        ids: (N,), of the samples.
    """

    tails: F64
    shafts: F64
    ids: Ids


def add_straight(
    group: Group, key: str, vectors: Vectors, width: float, color: Rgb, alpha: float
) -> None:
    """Draw an arrow along each vector.

    Args:
        group, key: where to draw, and what distinguishes the nodes there.
        vectors: to draw.
        width: of RViz's property Arrow Width, metres.
        color, alpha: of all.
    """
    lengths = np.linalg.norm(vectors.shafts, axis=1)
    segments = np.stack((vectors.tails, vectors.tails + (1 + HEAD) * vectors.shafts), axis=1)
    sizes = SHAFT_RADIUS * width, HEAD_RADIUS * width, HEAD * lengths
    add_solid_arrows(group, segments, color, *sizes, alpha, vectors.ids, key)


def add_turning(
    group: Group, key: str, vectors: Vectors, width: float, color: Rgb, alpha: float
) -> None:
    """Draw an arrow along each vector and a circle that turns about it; as `add_straight`."""
    add_straight(group, key, vectors, width, color, alpha)
    turns = matrices(rods(np.zeros_like(vectors.shafts), vectors.shafts, 0.0).wxyzs)
    radii = CIRCLE_RADIUS * np.linalg.norm(vectors.shafts, axis=1)[:, None]
    centers = vectors.tails + CIRCLE_HEIGHT * vectors.shafts
    points = centers[:, None] + radii[:, None] * np.einsum("nij,pj->npi", turns, _CIRCLE)
    segments = np.stack((points[:, :-1], points[:, 1:]), axis=2).reshape(-1, 2, 3)
    group.lines(
        f"{key} circles",
        segments,
        color,
        CIRCLE_LINE * width,
        "m",
        np.repeat(vectors.ids, len(_CIRCLE) - 1),
        alpha,
    )
    ends = points[:, -1]
    heads = np.stack((ends, ends + CIRCLE_HEAD * width * turns[:, :, 1]), axis=1)
    size = CIRCLE_HEAD * width
    add_solid_arrows(group, heads, color, 0.0, size, size, alpha, vectors.ids, f"{key} circle")
