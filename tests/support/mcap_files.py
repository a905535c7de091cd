"""MCAP files by hand, whose chunks may claim anything."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from zlib import crc32

import lz4.frame
import zstandard

from webviz.data.messages import encode

MAGIC = b"\x89MCAP0\r\n"
STRING = "std_msgs/msg/String"


def record(opcode: int, content: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(content)) + content


def text(value: str | bytes) -> bytes:
    data = value.encode() if isinstance(value, str) else value
    return struct.pack("<I", len(data)) + data


DEFINITIONS = record(
    3, struct.pack("<H", 1) + text(STRING) + text("ros2msg") + text("string data")
) + record(4, struct.pack("<HH", 1, 1) + text("/words") + text("cdr") + text(b""))
"""The schema of strings, and the channel /words."""


def message(stamp_ns: int, data: bytes | str) -> bytes:
    """A message on /words."""
    cdr = encode(STRING, {"data": data}) if isinstance(data, str) else data
    return record(5, struct.pack("<HIQQ", 1, 0, stamp_ns, stamp_ns) + cdr)


def words(*stamps_ns: int) -> bytes:
    """Messages that say their stamps."""
    return b"".join(message(stamp_ns, str(stamp_ns)) for stamp_ns in stamps_ns)


def packed(data: bytes, compression: str, *, with_size: bool = True, frames: int = 1) -> bytes:
    """Data compressed in several frames, which may contain their size."""
    if not compression:
        return data
    parts = [data[i * len(data) // frames : (i + 1) * len(data) // frames] for i in range(frames)]
    if compression == "lz4":
        return b"".join(lz4.frame.compress(part, store_size=with_size) for part in parts)
    compressor = zstandard.ZstdCompressor(write_content_size=with_size)
    return b"".join(compressor.compress(part) for part in parts)


@dataclass(frozen=True)
class Chunk:
    """A chunk of messages, as its record says.

    Args:
        data: packed.
        size: bytes to which it claims to unfold.
        compression: of it.
        span_ns: claimed times of its messages.
        crc: 0 for none.
    """

    data: bytes
    size: int
    compression: str = ""
    span_ns: tuple[int, int] = (0, 10)
    crc: int = 0

    @property
    def content(self) -> bytes:
        head = struct.pack("<QQQI", *self.span_ns, self.size, self.crc)
        return head + text(self.compression) + struct.pack("<Q", len(self.data)) + self.data


def plain(*stamps_ns: int, compression: str = "", with_size: bool = True, frames: int = 1) -> Chunk:
    """An honest chunk of words."""
    data = words(*stamps_ns)
    span_ns = (min(stamps_ns), max(stamps_ns))
    content = packed(data, compression, with_size=with_size, frames=frames)
    return Chunk(content, len(data), compression, span_ns, crc32(data))


def mcap(chunks: Sequence[Chunk | bytes], *, with_summary: bool = True) -> bytes:
    """A file of chunks, or of records outside of chunks."""
    out = bytearray(MAGIC + record(1, text("ros2") + text("by hand")) + DEFINITIONS)
    indices = b""
    for chunk in chunks:
        if isinstance(chunk, bytes):
            out += chunk
            continue
        offset = len(out)
        out += record(6, chunk.content)
        index = struct.pack("<QQQQ", *chunk.span_ns, offset, len(out) - offset)
        index += text(struct.pack("<HQ", 1, 0)) + struct.pack("<Q", 0) + text(chunk.compression)
        indices += record(8, index + struct.pack("<QQ", len(chunk.data), chunk.size))
    out += record(15, bytes(4))
    start = len(out) if with_summary else 0
    summary = DEFINITIONS + indices if with_summary else b""
    footer = struct.pack("<BQQQ", 2, 20, start, 0)
    crc = crc32(summary + footer) if with_summary else 0
    return bytes(out) + summary + footer + struct.pack("<I", crc) + MAGIC
