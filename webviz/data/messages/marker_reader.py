"""Decoding of a `visualization_msgs/Marker[]`, the slowest sequence if read field by field.

Almost all markers of an array have the layout of one before them: the same lengths of names, texts
and lists. So of each marker only the lengths are read, in one call, and compared with those that
followed last time; of markers whose layouts repeat, all at once. The fixed fields of all markers of
one layout are then read as arrays.
"""

from __future__ import annotations

from collections.abc import Sequence
from struct import Struct
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from webviz.data.messages.cdr import CdrError, Reader
from webviz.data.messages.geometry import NANOSECONDS, Header, Time
from webviz.data.messages.markers import (
    NO_FILE,
    NO_TEXTURE,
    NOTHING,
    CompressedImage,
    Content,
    MarkerSequence,
    MeshFile,
)

_NS = 1
_POINTS, _COLORS, _RESOURCE, _TEXTURE_FRAME, _FORMAT, _TEXTURE = 2, 3, 4, 5, 6, 7
_UV, _TEXT, _MESH, _FILE, _FILE_DATA = 8, 9, 10, 11, 12
"""Places in `_Layout.counts`."""

_FLOAT64, _FLOAT32, _UINT8 = np.dtype(np.float64), np.dtype(np.float32), np.dtype(np.uint8)
_EMPTY_STRINGS = (0, 1)
_NO_BYTES = NO_FILE.data
_FIRST_TRY = 8
"""Markers that follow as expected before their repetition is looked for; twice as many after each
failure."""
_LONGEST = 4
"""Longest run of markers whose repetition is looked for."""
_AT_ONCE = 10_000
"""Repetitions that are compared in one step, which takes 200 bytes for each marker."""
_UINT = {order: Struct(order + "I").unpack_from for order in "<>"}


class _Layout:
    """Offsets of the fields of a marker from its first byte.

    Args:
        reader: at the first byte of a marker, which is at a multiple of 4.

    Raises:
        CdrError: it is longer than the rest of the message.
    """

    def __init__(self, reader: Reader) -> None:
        self._data, self._end, self._uint = reader.data, reader.size, _UINT[reader.order]
        self._pos = self._start = reader.pos
        self.phase = reader.pos & 7
        counts: list[int] = []
        self.places: list[int] = []
        """Places of the counts in `counts`."""

        self._skip(8)
        self._list(counts, 1)  # frame_id
        self._list(counts, 1)  # ns
        self._align(4)
        self.kind = self._pos - self._start
        self._skip(12)
        self._align(8)
        self.pose = self._pos - self._start
        self._skip(80)
        self.color = self._pos - self._start
        self._skip(16 + 8)
        self.locked = self._pos - self._start
        self._skip(1)
        self._list(counts, 24, 8)
        self._list(counts, 16)
        self._list(counts, 1)  # texture_resource
        self._align(4)
        self.texture_stamp = self._pos - self._start
        self._skip(8)
        self._list(counts, 1)
        self._list(counts, 1)
        self._list(counts, 1)
        self._list(counts, 8)
        self._list(counts, 1)  # text
        self._list(counts, 1)  # mesh_resource
        self._list(counts, 1)
        self._list(counts, 1)
        self.last = self._pos - self._start
        self._skip(1)
        self.size = self._pos - self._start
        self.counts = tuple(counts)
        gaps = np.diff([-4, *self.places]) - 4
        self._codes = reader.order + "".join(f"{gap}xI" for gap in gaps)
        self._read: Any = None
        strings = (_RESOURCE, _TEXTURE_FRAME, _FORMAT, _TEXT, _MESH, _FILE)
        self.is_empty = all(counts[i] in _EMPTY_STRINGS for i in strings) and not any(
            counts[i] for i in (_POINTS, _COLORS, _TEXTURE, _UV, _FILE_DATA)
        )

    def fits(self, data: bytes | memoryview, pos: int, end: int) -> bool:
        """Return whether the marker at `pos` has this layout."""
        if pos & 7 != self.phase or pos + self.size > end:
            return False
        if self._read is None:
            self._read = Struct(self._codes).unpack_from
        return self._read(data, pos) == self.counts

    def _align(self, size: int) -> None:
        # The encapsulation has 4 bytes, and every field of 8 bytes is aligned behind it.
        self._pos += (4 - self._pos) & (size - 1)

    def _skip(self, size: int) -> None:
        self._pos += size
        if self._pos > self._end:
            raise CdrError("a marker is longer than the rest of the message")

    def _list(self, counts: list[int], item: int, align: int = 1) -> None:
        """Skip a count, and as many items of some bytes each."""
        self._align(4)
        self.places.append(self._pos - self._start)
        (count,) = self._uint(self._data, self._pos)
        counts.append(count)
        self._pos += 4
        if count:
            self._align(align)
            self._skip(count * item)


def read_markers(reader: Reader) -> MarkerSequence:
    """Read a `visualization_msgs/Marker[]`."""
    layouts, starts, numbers = _walk(reader, reader.count())
    places = np.array(starts, np.intp)
    which = np.array(numbers, np.intp)
    count = len(places)
    frame_ids, namespaces = [""] * count, [""] * count
    kinds, lifetimes = np.empty((count, 3), np.int32), np.empty(count, np.int64)
    stamps, poses = np.empty(count, np.int64), np.empty((count, 10), np.float64)
    colors = np.empty((count, 4), np.float32)
    locked, own = np.empty(count, np.bool_), np.empty(count, np.bool_)
    contents = [NOTHING] * count
    data = np.frombuffer(reader.data, np.uint8)
    for number, layout in enumerate(layouts):
        rows = np.flatnonzero(which == number)
        first = places[rows]
        heads = sliding_window_view(data, layout.locked + 1)[first]

        def read(start: int, width: int, dtype: str, heads: Any = heads) -> NDArray[Any]:
            part = heads[:, start : start + width * np.dtype(dtype).itemsize]
            return np.ascontiguousarray(part).view(reader.order + dtype)

        stamps[rows] = read(0, 1, "i4")[:, 0].astype(np.int64) * NANOSECONDS
        stamps[rows] += read(4, 1, "u4")[:, 0]
        kinds[rows] = read(layout.kind, 3, "i4")
        poses[rows] = read(layout.pose, 10, "f8")
        colors[rows] = read(layout.color, 4, "f4")
        lifetimes[rows] = read(layout.color + 16, 1, "i4")[:, 0].astype(np.int64) * NANOSECONDS
        lifetimes[rows] += read(layout.color + 20, 1, "u4")[:, 0]
        locked[rows] = heads[:, layout.locked] != 0
        own[rows] = data[first + layout.last] != 0
        listed = rows.tolist()
        for texts, place in ((frame_ids, 0), (namespaces, _NS)):
            start = layout.places[place] + 4
            column = heads[:, start : start + layout.counts[place]]
            for row, text in zip(listed, _strings(column), strict=True):
                texts[row] = text
        has_content = np.full(len(rows), not layout.is_empty)
        has_content |= sliding_window_view(data, 8)[first + layout.texture_stamp].any(axis=1)
        for index in np.flatnonzero(has_content).tolist():
            contents[listed[index]] = _content(reader, layout, int(first[index]))
    if layouts:
        reader.pos = starts[-1] + layouts[numbers[-1]].size
    arrays = (kinds, poses, colors, lifetimes, stamps, locked, own)
    for array in arrays:
        array.flags.writeable = False
    return MarkerSequence(
        frame_ids,
        stamps,
        namespaces,
        kinds[:, 0],
        kinds[:, 1],
        kinds[:, 2],
        poses[:, :3],
        poses[:, 3:7],
        poses[:, 7:],
        colors,
        lifetimes,
        locked,
        own,
        contents,
    )


def _walk(reader: Reader, count: int) -> tuple[list[_Layout], list[int], list[int]]:
    """Return the layouts, and the first byte and the number of the layout of each marker."""
    data, end, pos = reader.data, reader.size, reader.pos
    words = np.frombuffer(data, f"{reader.order}u4", len(data) // 4)
    layouts: list[_Layout] = []
    by_counts: dict[tuple[int, ...], int] = {}
    next_of: dict[int, int] = {}
    starts: list[int] = []
    numbers: list[int] = []
    last = -1
    expected, next_try = 0, _FIRST_TRY
    while len(starts) < count:
        pos = (pos + 3) & ~3
        number = next_of.get(last, -1)
        expected += 1
        if number < 0 or not layouts[number].fits(data, pos, end):
            expected = 0
            reader.pos = pos
            layout = _Layout(reader)
            number = by_counts.setdefault((layout.phase, *layout.counts), len(layouts))
            if number == len(layouts):
                layouts.append(layout)
            next_of[last] = number
        starts.append(pos)
        numbers.append(number)
        pos += layouts[number].size
        last = number
        if expected >= next_try:
            cycle, most = _cycle(numbers), count - len(starts)
            pos = (pos + 3) & ~3
            size = pos - starts[-len(cycle)] if cycle else 0
            again = _repeated([layouts[each] for each in cycle], words, pos, size, most)
            if again:
                jumps = np.arange(1, again + 1)[:, None] * size
                starts += (np.array(starts[-len(cycle) :]) + jumps).ravel().tolist()
                numbers += cycle * again
                pos = starts[-1] + layouts[last].size
            expected, next_try = 0, _FIRST_TRY if again else 2 * next_try
    return layouts, starts, numbers


def _cycle(numbers: list[int]) -> list[int]:
    """Return the last layouts if those before them were the same, [] if they were not."""
    for length in range(1, _LONGEST + 1):
        if numbers[-length:] == numbers[-2 * length : -length]:
            return numbers[-length:]
    return []


def _repeated(
    cycle: Sequence[_Layout], words: NDArray[np.uint32], pos: int, size: int, most: int
) -> int:
    """Return how many times markers of these layouts follow at `pos`, `most` markers at most.

    Args:
        words: of the message.
        size: bytes of the cycle, up to where the next one begins.
    """
    if not cycle or size % 8:
        return 0
    times = min(most // len(cycle), (words.nbytes - pos) // size, _AT_ONCE)
    if times < 1:
        return 0
    places, counts, start = [], [], pos
    for layout in cycle:
        start = (start + 3) & ~3
        places += [start + place for place in layout.places]
        counts += layout.counts
        start += layout.size
    each = np.array(places) // 4 + np.arange(times)[:, None] * (size // 4)
    is_same = (words[each] == np.array(counts, np.uint32)).all(axis=1)
    return times if is_same.all() else int(is_same.argmin())


def _strings(column: NDArray[np.uint8]) -> list[str]:
    """Return the strings (N, bytes), of which the last byte is NUL."""
    count, length = column.shape
    if not length:
        return [""] * count
    if column[:, -1].any():
        raise CdrError(f"a string of {length} bytes does not end in NUL")
    if count == 1 or (column == column[0]).all():
        return [_text(column[0].tobytes())] * count
    every = np.ascontiguousarray(column).tobytes()
    return [_text(every[i : i + length]) for i in range(0, count * length, length)]


def _text(raw: bytes) -> str:
    return str(raw[:-1], "utf-8", "replace")


def _content(reader: Reader, layout: _Layout, start: int) -> Content:
    """Return the fields of a marker whose size varies."""
    counts, places = layout.counts, layout.places

    def string(place: int) -> str:
        if counts[place] in _EMPTY_STRINGS:
            return ""
        reader.pos = start + places[place]
        return reader.string()

    def array(place: int, dtype: Any, width: int, empty: Any = _NO_BYTES) -> Any:
        if not counts[place]:
            return empty  # most are
        reader.pos = start + places[place] + 4
        numbers = reader.array(dtype, width * counts[place])
        return numbers if width == 1 else numbers.reshape(-1, width)

    texture, file = NO_TEXTURE, NO_FILE
    reader.pos = start + layout.texture_stamp
    stamp_ns, texture_frame, texture_format = (
        reader.stamp(),
        string(_TEXTURE_FRAME),
        string(_FORMAT),
    )
    if counts[_TEXTURE] or texture_frame or texture_format or stamp_ns:
        header = Header(Time(*divmod(stamp_ns, NANOSECONDS)), texture_frame)
        texture = CompressedImage(header, texture_format, array(_TEXTURE, _UINT8, 1))
    filename = string(_FILE)
    if counts[_FILE_DATA] or filename:
        file = MeshFile(filename, array(_FILE_DATA, _UINT8, 1))
    return Content(
        array(_POINTS, _FLOAT64, 3, NOTHING.points),
        array(_COLORS, _FLOAT32, 4, NOTHING.colors),
        string(_RESOURCE),
        texture,
        array(_UV, _FLOAT32, 2, NOTHING.uv_coordinates),
        string(_TEXT),
        string(_MESH),
        file,
    )
