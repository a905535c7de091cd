"""Colours of occupancy grid cells, byte for byte those of RViz."""

from __future__ import annotations

import functools
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Scheme = Literal["map", "costmap", "raw"]

_UNKNOWN = (112, 137, 134)
_ILLEGAL = (0, 255, 0)


@functools.lru_cache(maxsize=64)
def lookup_table(
    scheme: Scheme, alpha: float = 1.0, binary_threshold: int | None = None
) -> NDArray[np.uint8]:
    """Return the colour of each cell value.

    The values are those of rviz_default_plugins' palette_builder.cpp. A free cell of a costmap is
    transparent at any alpha; RViz shows it black at alpha 1.

    Args:
        scheme: RViz's colour scheme.
        alpha: 0 to 1, multiplies the palette's own.
        binary_threshold: legal values from here on get one colour, those below another; None
            keeps them apart.

    Returns:
        uint8 (256, 4) RGBA by the cell's int8 value read as uint8, not to be written to.
    """
    table = np.full((256, 4), 255, np.uint8)
    table[:, :3] = _raw() if scheme == "raw" else _legal_and_special(scheme)
    if scheme == "costmap" and binary_threshold is None:
        table[0, 3] = 0
    if binary_threshold is not None:
        below, above = _BINARY[scheme]
        end = 256 if scheme == "raw" else 101
        table[:binary_threshold, :3] = below
        table[binary_threshold:end, :3] = above
    table[:, 3] = np.rint(table[:, 3] * alpha)
    table.flags.writeable = False
    return table


_BINARY = {
    "map": ((255, 255, 255), (0, 0, 0)),
    "costmap": ((0, 0, 255), (255, 0, 0)),
    "raw": ((0, 0, 0), (255, 255, 255)),
}


def _raw() -> NDArray[np.uint8]:
    return np.repeat(np.arange(256, dtype=np.uint8)[:, None], 3, axis=1)


def _legal_and_special(scheme: Scheme) -> NDArray[np.uint8]:
    """Return the colours outside the legal values 0 to 100, shared by map and costmap."""
    colors = np.empty((256, 3), np.uint8)
    legal = (255 * np.arange(101)) // 100
    if scheme == "map":
        colors[:101] = (255 - legal)[:, None]
    else:
        colors[:101] = np.stack((legal, np.zeros(101), 255 - legal), axis=1)
        colors[0] = 0
        colors[99] = (0, 255, 255)
        colors[100] = (255, 0, 255)
    colors[101:128] = _ILLEGAL
    negative = (255 * np.arange(127)) // 126  # -128 to -2
    colors[128:255] = np.stack((np.full(127, 255), negative, np.zeros(127)), axis=1)
    colors[255] = _UNKNOWN
    return colors
