"""Points of many sizes, for a browser that draws each cloud in one size."""

from __future__ import annotations

from collections.abc import Iterator

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
    steps = np.log(np.clip(sizes, LEAST_M, MOST_M)) / np.log(RATIO)
    numbers = np.ceil(steps - 1e-4).astype(np.int16)
    middle = int(np.median(numbers))
    numbers = np.clip(numbers, middle - REACH, middle + REACH)
    for number in np.unique(numbers).tolist():
        yield str(number), np.flatnonzero(numbers == number), RATIO**number
