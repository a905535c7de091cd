"""Frames that are no longer published turn grey, then fade, then disappear."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
U8 = NDArray[np.uint8]

GREY = 178.5
"""RViz's 0.7 of white."""

STILL_S = 1.0
"""Age from which a frame that has stopped ages from the reception of its transform."""

STEPS = 10
"""Levels of opacity: the browser rebuilds a batch of transparent solids for each new one."""


class Ages:
    """Time since the transform of each frame last changed, in ROS time.

    A stamp is not enough: that of a bag played without its clock, or of a machine whose clock is
    wrong, may be of another day, yet its frames move. A frame therefore ages from when its newest
    stamp was received, whether that was seen in passing or not.
    """

    def __init__(self) -> None:
        self._stamps_ns = np.zeros(0, np.int64)
        self._changed_ns = np.zeros(0, np.int64)
        self._is_exact = np.zeros(0, np.bool_)
        """True if a time is that of reception, instead of the tick that noticed it."""

    def update(
        self,
        stamps_ns: NDArray[np.int64],
        now_ns: int,
        seen_ns: Callable[[], Mapping[int, int]],
    ) -> F64:
        """Ages in seconds, float64 (N,); 0 for frames with static transforms only.

        Args:
            stamps_ns: int64 (N,), the newest stamp of each frame, 0 for static ones. Frames keep
                their places from call to call; new ones are appended.
            now_ns: ROS time.
            seen_ns: the times of reception by stamp, both in nanoseconds; asked only for frames
                that are new or that have stopped.
        """
        known, count = len(self._stamps_ns), len(stamps_ns)
        same = np.zeros(count, np.bool_)
        same[:known] = stamps_ns[:known] == self._stamps_ns
        changed_ns = np.full(count, now_ns)
        changed_ns[:known] = np.where(same[:known], self._changed_ns, now_ns)
        is_exact = stamps_ns == 0
        is_exact[:known] |= same[:known] & self._is_exact
        is_asked = ~is_exact & (now_ns - changed_ns > STILL_S * 1e9)
        is_asked[known:] |= ~is_exact[known:]
        if is_asked.any():
            received_ns = seen_ns()
            for place in np.flatnonzero(is_asked).tolist():
                stamp_ns = int(stamps_ns[place])
                noticed_ns = int(changed_ns[place]) if place < known else stamp_ns
                changed_ns[place] = min(received_ns.get(stamp_ns, noticed_ns), now_ns)
            is_exact |= is_asked
        self._stamps_ns, self._changed_ns, self._is_exact = stamps_ns, changed_ns, is_exact
        return np.where(stamps_ns == 0, 0.0, (now_ns - changed_ns) / 1e9)


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
