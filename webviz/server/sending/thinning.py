"""Clouds with fewer points, for browsers on slow links."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

PATIENCE_S = 0.3
"""Seconds of the link that all clouds together may take."""
MOVING_S = 2.0
"""Clouds that did not change for so long do not count: they are sent whole once there is time."""
MAX_RATIO = 1 << 12
"""Largest number of points of which one is sent."""


def is_cloud(updates: dict[str, Any]) -> bool:
    """Return whether properties are those of a cloud of points."""
    points = updates.get("points")
    return isinstance(points, np.ndarray) and points.ndim == 2


def thinned(message: Any, every: int) -> Any:
    """Return a message of a cloud with one of `every` points.

    They are drawn by lot, always the same ones: of a lidar whose points come ring by ring, each
    8th would be points of a single ring.
    """
    count = len(message.updates["points"])
    rows = chosen(count, every)
    updates = {
        name: value[rows] if isinstance(value, np.ndarray) and len(value) == count else value
        for name, value in message.updates.items()
    }
    return replace(message, updates=updates)


def chosen(count: int, every: int) -> NDArray[np.intp]:
    """Rows of a cloud of `count` points, one of `every`; see `thinned`."""
    starts = np.arange(0, count, every)
    rows = starts + np.random.default_rng(0).integers(0, every, len(starts))
    return np.minimum(rows, count - 1)


class Thinning:
    """Chooses of how many points one is sent: a power of two, for all clouds of a browser.

    Args:
        clock: the time in seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._sizes: dict[object, tuple[float, int]] = {}
        self.every = 1

    def note(self, key: object, size: int) -> None:
        """Note the size in bytes of a new version of a cloud."""
        self._sizes[key] = self._clock(), size

    def choose(self, rate: float | None) -> int:
        """Return of how many points one is sent, on a link of that many bytes per second."""
        now = self._clock()
        self._sizes = {k: each for k, each in self._sizes.items() if now - each[0] < MOVING_S}
        if rate is None:
            self.every = 1
        elif self._sizes:
            ratio = sum(size for _, size in self._sizes.values()) / (rate * PATIENCE_S)
            step = 2 ** math.ceil(math.log2(min(max(ratio, 1.0), MAX_RATIO)))
            # Rates vary: back only to what still fits with some room.
            if step > self.every or ratio < 0.45 * self.every:
                self.every = step
        return self.every
