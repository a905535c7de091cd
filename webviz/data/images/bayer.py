"""Colours of a Bayer mosaic, by bilinear interpolation."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def demosaic(mosaic: NDArray[Any], pattern: str) -> NDArray[Any]:
    """Return the colours of a mosaic: missing ones are means of their two or four neighbours.

    Args:
        mosaic: unsigned integers (H, W).
        pattern: colours of the first two pixels of the first two rows, such as "rggb".

    Returns:
        RGB (H, W, 3) of the same type.
    """
    height, width = mosaic.shape
    # Mirrored at the border pixel, so that a neighbour keeps its colour.
    before, after = (int(height > 1), int(width > 1))
    padded = np.pad(mosaic, ((before, before), (after, after)), "reflect")
    padded = np.pad(padded, ((1 - before, 1 - before), (1 - after, 1 - after)), "edge")
    wide = padded.astype(np.uint32)
    centre = wide[1:-1, 1:-1]
    beside = (wide[1:-1, :-2] + wide[1:-1, 2:] + 1) // 2
    above = (wide[:-2, 1:-1] + wide[2:, 1:-1] + 1) // 2
    cross = (wide[1:-1, :-2] + wide[1:-1, 2:] + wide[:-2, 1:-1] + wide[2:, 1:-1] + 2) // 4
    corners = (wide[:-2, :-2] + wide[:-2, 2:] + wide[2:, :-2] + wide[2:, 2:] + 2) // 4
    rgb = np.empty((height, width, 3), mosaic.dtype)
    for cell, color in enumerate(pattern):
        at = np.s_[cell // 2 :: 2, cell % 2 :: 2]
        if color == "g":
            is_red_row = "r" in pattern[cell // 2 * 2 : cell // 2 * 2 + 2]
            rgb[at][..., 0] = (beside if is_red_row else above)[at]
            rgb[at][..., 1] = centre[at]
            rgb[at][..., 2] = (above if is_red_row else beside)[at]
        else:
            own, other = (0, 2) if color == "r" else (2, 0)
            rgb[at][..., own] = centre[at]
            rgb[at][..., 1] = cross[at]
            rgb[at][..., other] = corners[at]
    return rgb
