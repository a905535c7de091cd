"""The range of values that an image shows: RViz's, but without rounding to whole numbers."""

from __future__ import annotations

import statistics
from collections import deque

from webviz.data.images import RawImage, value_range, values


class RunningRange:
    """The medians of the lowest and the highest values of the newest images."""

    def __init__(self) -> None:
        self._seen: deque[tuple[int, tuple[float, float]]] = deque()

    def of(self, number: int, image: RawImage, window: int) -> tuple[float, float] | None:
        """Return the range for an image, None if no image of the window has a valid value.

        Args:
            number: of the message; the same message counts once.
            image: of measurements.
            window: number of images.
        """
        if not self._seen or self._seen[-1][0] != number:
            found = value_range(values(image), image.layout.zero_is_invalid)
            if found is not None:
                self._seen.append((number, found))
        while len(self._seen) > window:
            self._seen.popleft()
        if not self._seen:
            return None
        ranges = [each for _, each in self._seen]
        low = statistics.median(low for low, _ in ranges)
        return low, statistics.median(high for _, high in ranges)
