"""Fewer points that look the same."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

Rows = NDArray[np.intp]

_CELLS = 1 << 21
"""Voxels along each axis until their numbers repeat: three such numbers fit 63 bits."""

_SPREAD = 0x9E3779B97F4A7C15
"""2^64 divided by the golden ratio, which scatters numbers (Knuth, TAOCP 3, section 6.4)."""

_LEAST_VOXEL = 1e-4
"""Metres."""


@functools.lru_cache(maxsize=4)
def evenly(total: int, limit: int) -> Rows:
    """`limit` of `total` rows, ascending: one from each of `limit` equal parts.

    Always the same for the same numbers, so that a scene at rest stands still; not at equal
    distances, which would show as stripes in an organised cloud.
    """
    edges = np.arange(limit + 1, dtype=np.intp) * total // limit
    spans = np.diff(edges)
    rows = edges[:-1] + (np.random.default_rng(0).random(limit) * spans).astype(np.intp)
    rows.flags.writeable = False
    return rows


def one_per_voxel(xyz: NDArray[np.float32], size: float) -> Rows:
    """Return the first point of each voxel, ascending rows of (N, 3).

    Args:
        xyz: finite points, metres.
        size: edge of a voxel in metres; two voxels 2 million edges apart count as one.
    """
    size = max(size, _LEAST_VOXEL)
    numbers = np.zeros(len(xyz), np.int64)
    for axis in range(3):
        numbers *= _CELLS
        numbers += np.floor(xyz[:, axis] / size).astype(np.int64)
    # Sorting a million numbers takes longer than the rest of a display, hence a hash table.
    # The last writer owns a slot; points of other voxels retry in a new table.
    bits = max(len(xyz), 2).bit_length()
    table = np.empty(1 << bits, np.intp)
    left = np.arange(len(xyz))
    is_owner = np.zeros(len(xyz), np.bool_)
    spread = _SPREAD
    while len(left):
        mine = numbers[left]
        slots = ((mine.view(np.uint64) * np.uint64(spread)) >> np.uint64(64 - bits)).view(np.intp)
        table[slots[::-1]] = left[::-1]
        owners = table[slots]
        is_owner[owners] = True
        left = left[numbers[owners] != mine]
        spread = spread * _SPREAD % 2**64
    return np.flatnonzero(is_owner)
