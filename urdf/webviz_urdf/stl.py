"""Binary STL files whose size contradicts their header, mended as RViz's reader takes them."""

from __future__ import annotations

import struct

HEADER, TRIANGLE = 84, 50
"""Bytes of the header with its count, and of each triangle."""
TEXT_BYTES = 1000
"""In which an ASCII file has its first facet, and no zeros."""


def whole_stl(data: bytes) -> bytes:
    """Return an STL file whose count of triangles fits its size.

    Bytes behind the triangles are dropped, and a count of zero is that of the bytes, since some
    exporters write it before they know it.

    Raises:
        ValueError: a binary file was cut off.
    """
    if len(data) < HEADER or _is_text(data):
        return data
    (count,) = struct.unpack_from("<I", data, HEADER - 4)
    room = (len(data) - HEADER) // TRIANGLE
    if count > room:
        raise ValueError(f"it is cut off after {room} of {count} triangles")
    count = count or room
    return data[: HEADER - 4] + struct.pack("<I", count) + data[HEADER : HEADER + TRIANGLE * count]


def _is_text(data: bytes) -> bool:
    start = data[:TEXT_BYTES]
    return b"\0" not in start and b"facet" in start.lower()
