"""One curve of the panel Plot: a number of the messages of a topic."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any

from webviz.api.chart import Chunk
from webviz.data.messages import KNOWN, MessageTypes, types_of
from webviz.data.messages.geometry import Header
from webviz.data.messages.message_paths import MessagePath, OverTime
from webviz.data.messages.paths import NothingMatches, PathError

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
        if self._chunks is None or self._chunks[0] != self._revision:
            points = [*self._open, *self._pending()]
            newest = Chunk(self._number, *_columns(points))
            self._chunks = self._revision, (*self._closed, newest)
        return self._chunks[1]

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
        self._chunks: tuple[int, tuple[Chunk, ...]] | None = None

    def _flush(self) -> None:
        for point in self._pending():
            self._append(point)
        self._bucket = None
        self._has_gap = False

    def _pending(self) -> list[Point]:
        """Return the points kept of the newest interval, in order of time, each value once."""
        points = sorted(set(self._bucket or ()), key=lambda point: point[0])
        if points and self._has_gap:
            points.append((points[-1][0], math.nan))
        return points

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


How = tuple[float, str]
"""Window in seconds, and which time is used."""


class Series:
    """The values of one curve.

    Args:
        text: the message path of a number.
        how: see `How`.
        before: the same curve with another window, whose values it takes over if their times are
            of the same kind.
    """

    def __init__(self, text: str, how: How, before: Series | None = None) -> None:
        self.how = how
        self.topic = ""
        self.problem = ""
        """Reason why the newest message has no value."""
        self.has_stamp = True
        self._types: MessageTypes = KNOWN if before is None else before._types
        """Types that define the type of the newest message."""
        self._path: MessagePath | None = None
        self._over_time: OverTime | None = None
        self._invalid = ""
        self.history = CurveHistory(how[0])
        try:
            self._path = path = MessagePath(text)
        except PathError as error:
            self._invalid = str(error)
        else:
            self.topic = path.topic
            self._over_time = path.over_time()
            if not path.has_field:
                self._invalid = f"`{text[:80]}` has no field. Add one, such as {text[:80]}.data."
        if before is not None and before.how[1] == how[1]:
            for point in before.history.points():
                self.history.add(*point)

    def add(self, message: Any, received_ns: int, *, by_stamp: bool) -> None:
        """Add the value of a message."""
        if self._path is None:
            return
        self._types = types_of(message)
        try:
            value = self._path.number(message)
        except NothingMatches as error:  # the element may be in the next message
            self.problem = "" if self.history.newest else str(error)
            return
        except PathError as error:
            self.problem = str(error)
            self.history.gap()
            return
        self.problem = ""
        self.has_stamp = isinstance(getattr(message, "header", None), Header)
        time_s = _time_s(message, received_ns, by_stamp=by_stamp)
        self.history.add(time_s, self._over_time(time_s, value) if self._over_time else value)

    def is_behind(self, message: Any, received_ns: int, *, by_stamp: bool) -> bool:
        """Return whether it has no value as new as that of a message."""
        newest = self.history.newest
        return newest is None or newest[0] < _time_s(message, received_ns, by_stamp=by_stamp)

    def unit(self, types: Mapping[str, str]) -> str:
        """Return the unit of the values, "" if the type of the messages states none."""
        return self._path.unit(types.get(self.topic, ""), self._types) if self._path else ""

    def clear(self) -> None:
        """Forget all values."""
        self.history = CurveHistory(self.how[0])
        self.problem = ""
        self._over_time = self._path.over_time() if self._path else None

    def explanation(self, types: Mapping[str, str]) -> str:
        """Return why the curve has no new values, or what to know of them; a sentence or ""."""
        if self._invalid:
            return self._invalid
        if self.topic not in types:
            return f"No publisher on {self.topic}. Start the node that publishes it."
        if self.problem:
            return self.problem
        if self.history.newest is None:
            return "No message yet."
        if not self.has_stamp and self.how[1] != "Received":
            return "The messages have no header: the times are those of their arrival."
        if self.history.late:
            return f"{self.history.late} values were left out: their times go back."
        return ""


def _time_s(message: Any, received_ns: int, *, by_stamp: bool) -> float:
    header = getattr(message, "header", None)
    return (header.stamp_ns if by_stamp and isinstance(header, Header) else received_ns) / 1e9
