"""The values of one curve over a window of time, with a bound on their number."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from webviz.api.chart import Chunk

BUCKETS = 2000
"""Intervals of a window. Of each at most the first, lowest, highest and last value are kept, which
draw the same lines as all values on a screen with that many columns."""
CHUNKS = 40
"""Pieces of a window that pages receive one after the other."""
MAX_POINTS = 5 * (BUCKETS + 2 * BUCKETS // CHUNKS)
"""Values of a curve that are kept at most."""
BACK_S = 0.1
"""A value that is older than the one before by more than this starts the curve over."""

Point = tuple[float, float]


class CurveHistory:
    """The values of one curve.

    Args:
        window_s: time that is kept, in seconds.
    """

    def __init__(self, window_s: float) -> None:
        self.late = 0
        """Values that were left out, because a newer one came before them."""
        self._bucket_s = window_s / BUCKETS
        self._chunk_s = window_s / CHUNKS
        self._numbers = itertools.count()
        self._start_over()

    def add(self, time_s: float, value: float) -> None:
        """Add a value; one that is not finite ends a line."""
        if self.newest is not None and time_s < self.newest[0]:
            if time_s > self.newest[0] - BACK_S:
                self.late += 1
                return
            self._start_over()
        self._revision += 1
        self.newest = point = (time_s, value)
        if not math.isfinite(value):
            self._has_gap = True
            return
        index = math.floor(time_s / self._bucket_s)
        if self._bucket is None or self._index != index:
            self._flush()
            self._index, self._bucket = index, [point, point, point, point]
            return
        _, low, high, _ = bucket = self._bucket
        bucket[3] = point
        if value < low[1]:
            bucket[1] = point
        elif value > high[1]:
            bucket[2] = point

    def gap(self) -> None:
        """End the line, because values may be missing."""
        if self.newest is not None:
            self.add(self.newest[0], math.nan)

    def chunks(self) -> tuple[Chunk, ...]:
        """All values, oldest first; the same objects as before if they have not changed."""
        if self._shown is None or self._shown[0] != self._revision:
            points = [*self._open, *self._pending()]
            newest = Chunk(self._number, *_columns(points))
            self._shown = self._revision, (*self._closed, newest)
        return self._shown[1]

    def points(self) -> list[Point]:
        """All values that are kept, oldest first; NaN where a line ends."""
        return [
            point
            for chunk in self.chunks()
            for point in zip(chunk.times_s, chunk.values, strict=True)
        ]

    def _start_over(self) -> None:
        self.newest: Point | None = None
        """The newest value, also if it is not finite."""
        self._closed: list[Chunk] = []
        self._open: list[Point] = []
        self._bucket: list[Point] | None = None
        self._has_gap = False
        self._index = 0
        self._number = next(self._numbers)
        self._revision = 0
        self._shown: tuple[int, tuple[Chunk, ...]] | None = None

    def _flush(self) -> None:
        for point in self._pending():
            self._append(point)
        self._bucket = None
        self._has_gap = False

    def _pending(self) -> list[Point]:
        """Return the points kept of the newest interval, in order of time, each value once."""
        kept = sorted(set(self._bucket or ()), key=lambda point: point[0])
        if kept and self._has_gap:
            kept.append((kept[-1][0], math.nan))
        return kept

    def _append(self, point: Point) -> None:
        if self._open and point[0] - self._open[0][0] >= self._chunk_s:
            self._closed.append(Chunk(self._number, *_columns(self._open)))
            self._number = next(self._numbers)
            self._open = []
            oldest = point[0] - self._chunk_s * CHUNKS
            while self._closed and self._closed[0].times_s[-1] < oldest:
                del self._closed[0]
        self._open.append(point)


def _columns(points: Sequence[Point]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    return tuple(point[0] for point in points), tuple(point[1] for point in points)
