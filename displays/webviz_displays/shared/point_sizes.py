"""Points of many sizes, for a browser that draws each cloud in one size."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

RATIO = 1.15
"""Between the sizes of neighbouring clouds; sizes are rounded up, as gaps would let a wall shine
through."""
REACH = 10
"""Clouds of smaller and of larger points than the median; those beyond join the last ones."""
LEAST_M, MAX_M = 1e-6, 1e6


def by_size(
    sizes: NDArray[np.floating],
) -> tuple[NDArray[np.intp], Sequence[tuple[str, slice, float]]]:
    """Return an order of points (N,) in which those of nearly the same size are neighbours.

    Args:
        sizes: (N,), metres.

    Returns:
        The order, and of each group a name that stays the same, where it is in the order, and the
        size.
    """
    if not len(sizes):
        return np.zeros(0, np.intp), ()
    steps = np.log(np.clip(sizes, LEAST_M, MAX_M)) / math.log(RATIO)
    numbers = np.ceil(steps - 1e-4).astype(np.int16)
    least = int(numbers.min())
    counts = np.bincount(numbers - least)
    middle = least + int(np.searchsorted(np.cumsum(counts), len(sizes) // 2, side="right"))
    lowest = middle - REACH
    slots = np.clip(np.arange(least, least + len(counts)), lowest, middle + REACH) - lowest
    ends = np.cumsum(np.bincount(slots, counts)).astype(int).tolist()
    # Sorted twice as fast as int16.
    order = np.argsort(
        (np.clip(numbers, lowest, middle + REACH) - lowest).astype(np.uint8), kind="stable"
    )
    return order, [
        (str(number), slice(start, end), RATIO**number)
        for number, (start, end) in enumerate(pairwise((0, *ends)), lowest)
        if end > start
    ]
