"""Packing of messages as viser's page reads them, into whole websocket frames."""

from __future__ import annotations

import struct
import time
from collections.abc import Sequence

import msgspec
import zstandard
from viser.infra._messages import Message

from webviz.server.sending.frame_header import header
from webviz.server.sending.pieces import Piece

ALIGNMENT = 8
"""Bytes; typed arrays of JavaScript begin at multiples of their items' size."""
_packer = msgspec.msgpack.Encoder()


class Packer:
    """Packs messages; one thread may use it at a time."""

    def __init__(self) -> None:
        self._zstd = zstandard.ZstdCompressor(level=1)

    def frame(self, messages: Sequence[Message | Piece]) -> bytes:
        """Return a websocket frame without mask, which is the same for all browsers.

        It contains the size of the msgpack before and after compression, the msgpack, and the
        arrays, each at a multiple of `ALIGNMENT`.
        """
        arrays: list[memoryview] = []
        packed = _packer.encode(
            {
                "messages": [message.as_serializable_dict(arrays) for message in messages],
                "timestampSec": time.perf_counter(),
                "binaryBufferLengths": [array.nbytes for array in arrays],
            }
        )
        compressed = self._zstd.compress(packed)
        sizes = struct.pack("<QQ", len(packed), len(compressed))
        parts: list[bytes | memoryview] = [b"", sizes, compressed]
        size = len(sizes) + len(compressed)
        for array in arrays:
            padding = -size % ALIGNMENT
            parts += [bytes(padding), array]
            size += padding + array.nbytes
        parts[0] = header(size)
        return b"".join(parts)
