"""Points of many sizes, for a browser that draws each cloud in one size."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

RATIO = 1.3
"""Between the sizes of neighbouring clouds; sizes are rounded up, as gaps would let a wall shine
through."""
REACH = 6
"""Clouds of smaller and of larger points than the median; those beyond join the last ones."""
LEAST_M, MOST_M = 1e-6, 1e6


def by_size(sizes: NDArray[np.floating]) -> Iterator[tuple[str, NDArray[np.intp], float]]:
    """Points of nearly the same size: a name that stays the same, the indices, and the size.

    Args:
        sizes: (N,), metres.
    """
    if not len(sizes):
        return
    steps = np.log(np.clip(sizes, LEAST_M, MOST_M)) / math.log(RATIO)
    numbers = np.ceil(steps - 1e-4).astype(np.int16)
    least = int(numbers.min())
    up_to = np.cumsum(np.bincount(numbers - least))
    middle = least + int(np.searchsorted(up_to, len(sizes) // 2, side="right"))
    numbers = np.clip(numbers, middle - REACH, middle + REACH)
    order = np.argsort(numbers, kind="stable")
    ends = np.cumsum(np.bincount(numbers - (middle - REACH))).tolist()
    for number, (start, end) in enumerate(pairwise((0, *ends)), middle - REACH):
        if end > start:
            yield str(number), order[start:end], RATIO**number
