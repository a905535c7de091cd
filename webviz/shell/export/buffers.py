"""Arrays and bytes of a part of a recorded run, arranged so that they compress well."""

from __future__ import annotations

import msgspec
import numpy as np

from webviz.server.sending.thinning import chosen

ALIGNMENT = 8
"""Bytes; browsers make numbers only of what is aligned."""
SHUFFLED_BYTES = 256
"""Arrays from this size on have the first bytes of all their numbers first, then the second ones
and so on, which compresses floats by a third more."""


class _Buffer(msgspec.Struct, frozen=True):
    """Bytes of a chunk.

    Args:
        data: an array, or bytes.
        width: size of its numbers in bytes if these are shuffled, else 1.
        rows: how many points it has, 0 if it is not of a cloud.
        kind: of buffers that are alike, and compressed side by side.
    """

    data: memoryview
    width: int
    rows: int = 0
    kind: str = ""

    def packed(self, every: int) -> bytes:
        """Return the bytes as they are compressed, of a cloud with one of `every` points."""
        flat = np.frombuffer(self.data, np.uint8)
        if self.rows and every > 1:
            flat = flat.reshape(self.rows, -1)[chosen(self.rows, every)].ravel()
        if self.width > 1:
            flat = np.ascontiguousarray(flat.reshape(-1, self.width).T)
        return flat.tobytes()


class Buffers:
    """The binary part of a chunk."""

    def __init__(self) -> None:
        self._all: list[_Buffer] = []
        self.size = 0
        """Bytes before compression."""

    def add(
        self,
        data: memoryview | bytes,
        dtype: str = "",
        rows: int = 0,
        kind: str = "",
    ) -> int:
        """Add an array or bytes; its number."""
        view = memoryview(data)
        item = np.dtype(dtype).itemsize if dtype else 1
        width = item if item > 1 and view.nbytes >= SHUFFLED_BYTES else 1
        self._all.append(_Buffer(view, width, rows, kind))
        self.size += view.nbytes
        return len(self._all) - 1

    def packed(self, every: int) -> tuple[list[tuple[int, int, int]], bytes]:
        """Start, size and width of each, and all of them."""
        whole, index = bytearray(), [(0, 0, 1)] * len(self._all)
        for number, buffer in sorted(enumerate(self._all), key=lambda each: each[1].kind):
            data = buffer.packed(every)
            whole += bytes(-len(whole) % ALIGNMENT)
            index[number] = len(whole), len(data), buffer.width
            whole += data
        return index, bytes(whole)
