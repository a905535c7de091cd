"""Frames that are no longer published turn grey, then fade, then disappear."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
U8 = NDArray[np.uint8]

GREY = 178.5
"""RViz's 0.7 of white."""

STEPS = 10
"""Levels of opacity: the browser rebuilds a batch of transparent solids for each new one."""


class Ages:
    """Time since the transform of each frame last changed, in ROS time.

    A stamp alone is not enough: a bag played without its clock has stamps of another day, yet its
    frames move. A frame therefore ages from when it was first seen, and anew with each new stamp.
    """

    def __init__(self) -> None:
        self._stamps_ns = np.zeros(0, np.int64)
        self._changed_ns = np.zeros(0, np.int64)

    def update(self, stamps_ns: NDArray[np.int64], now_ns: int) -> F64:
        """Ages in seconds, float64 (N,); 0 for frames with static transforms only.

        Args:
            stamps_ns: int64 (N,), the newest stamp of each frame, 0 for static ones. Frames keep
                their places from call to call; new ones are appended.
            now_ns: ROS time.
        """
        known = len(self._stamps_ns)
        same = stamps_ns[:known] == self._stamps_ns
        self._changed_ns = np.concatenate(
            (np.where(same, self._changed_ns, now_ns), np.minimum(stamps_ns[known:], now_ns))
        )
        self._stamps_ns = stamps_ns
        return np.where(stamps_ns == 0, 0.0, (now_ns - self._changed_ns) / 1e9)


def fade(ages: F64, timeout: float) -> tuple[F64, F64]:
    """Greyness and opacity of frames by age, each 0 to 1, as in RViz.

    Up to a third of the timeout a frame has its colours, up to two thirds it turns grey, then it
    becomes transparent, in `STEPS` steps.
    """
    thirds = 3.0 * ages / timeout
    opacity = np.ceil(np.clip(3.0 - thirds, 0.0, 1.0) * STEPS) / STEPS
    return np.clip(thirds - 1.0, 0.0, 1.0), opacity


def faded(colors: F64, greyness: F64) -> U8:
    """Colours (M, 3), 0 to 255, for N frames of this greyness (N,); uint8 (N, M, 3)."""
    return np.rint(colors + greyness[:, None, None] * (GREY - colors)).astype(np.uint8)
