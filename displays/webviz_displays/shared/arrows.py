"""Arrows that stand for poses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]


def along_x(positions: F64, rotations: F64, length: float) -> F64:
    """Arrows from positions along the x axes of their rotations, as RViz draws a pose.

    Args:
        positions: (N, 3), metres.
        rotations: (N, 3, 3).
        length: of shaft and head together, metres.

    Returns:
        Tails and tips (N, 2, 3).
    """
    return np.stack((positions, positions + length * rotations[..., 0]), axis=1)
