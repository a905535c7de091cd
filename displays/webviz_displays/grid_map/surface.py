"""The surface over the cells of a grid map."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

F32 = NDArray[np.float32]
U32 = NDArray[np.uint32]
Mask = NDArray[np.bool_]

_TRIANGLES = (
    ((0, 2, 1), (1, 2, 3)),
    ((1, 2, 3),),
    ((0, 2, 3),),
    ((0, 3, 1),),
    ((0, 2, 1),),
)
"""Counter-clockwise from above, of four neighbours: those of the next column and row are 1 and 2,
that of both 3. First if all are there, then without 0, 1, 2, 3."""


def places(shape: tuple[int, int], resolution: float, heights: F32) -> F32:
    """Return the centres (rows, columns, 3) of all cells, metres from the centre of the map."""
    rows, columns = (resolution * ((count - 1) / 2 - np.arange(count)) for count in shape)
    x, y = np.meshgrid(rows, columns, indexing="ij")
    return np.stack((x, y, heights), axis=-1).astype(np.float32)


def faces_of(is_valid: Mask) -> U32:
    """Triangles (N, 3) between neighbours, by the number of each among the valid cells.

    Args:
        is_valid: (rows, columns), which cells have a place.
    """
    numbers = np.cumsum(is_valid, dtype=np.uint32).reshape(is_valid.shape) - np.uint32(1)
    corners = [np.s_[:-1, :-1], np.s_[:-1, 1:], np.s_[1:, :-1], np.s_[1:, 1:]]
    is_there = np.stack([is_valid[corner] for corner in corners], axis=-1)
    four = np.stack([numbers[corner] for corner in corners], axis=-1)
    missing = 4 - is_there.sum(axis=-1)
    cases = np.where(missing == 0, 0, np.where(missing == 1, 1 + np.argmin(is_there, axis=-1), -1))
    found = [four[cases == case][:, triangles].reshape(-1, 3)
             for case, triangles in enumerate(map(np.array, _TRIANGLES))]  # fmt: skip
    return np.concatenate(found)


def lines_of(points: F32, is_valid: Mask, step: int) -> F32:
    """Segments (N, 2, 3) along every `step`-th row and column and the last ones.

    Args:
        points: (rows, columns, 3).
        is_valid: (rows, columns), which of them there are.
        step: at least 1.
    """
    found = []
    for axis in (0, 1):
        across = points.shape[axis]
        chosen = np.unique(np.append(np.arange(0, across, step), across - 1))
        some = np.take(points, chosen, axis).swapaxes(0, axis)
        there = np.take(is_valid, chosen, axis).swapaxes(0, axis)
        segments = np.stack((some[:, :-1], some[:, 1:]), axis=2)
        found.append(segments[there[:, :-1] & there[:, 1:]])
    return np.concatenate(found)
