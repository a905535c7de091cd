"""Chunks of MCAP files: what their records and the summary say of them, and their contents."""

from __future__ import annotations

import itertools
import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import BinaryIO, NamedTuple
from zlib import crc32

import msgspec
import numpy as np
import numpy.typing as npt

from webviz.data.recordings.mcap_records import (
    MESSAGE_INDEX,
    PREFIX,
    RecordFields,
)
from webviz.data.recordings.recording import BrokenRecord
from webviz.data.recordings.unpacking import COMPRESSIONS, MAX_BYTES, unpack

SMALL = 16 << 10
"""Bytes of a message. Transforms and scans have less, images and clouds more."""
CHUNK_FIELDS = struct.Struct("<QQQII")
"""First and last time, size and checksum when unpacked, length of the compression's name."""
CRC_OFFSET = 24
INDEX_FIELDS = struct.Struct("<BQHI")
"""Prefix, channel, and bytes of the entries of a record that indexes messages."""
CHANNEL_COUNTS = np.dtype([("channel", "<u2"), ("count", "<u4")])
ChannelCounts = npt.NDArray[np.void]
INDEX_ENTRY = np.dtype([("stamp_ns", "<u8"), ("offset", "<u8")])


@dataclass(frozen=True)
class McapChunk:
    """A part of the file that contains messages.

    Args:
        offset: of its packed data in the file.
        packed_size: bytes of that.
        size: bytes that it claims to unfold to.
        crc: of these, 0 if unknown.
        compression: "" for none.
        start_ns, end_ns: claimed times of its messages.
        counts: messages of each channel, `CHANNEL_COUNTS`; None if unknown.
        index: offset and size of the records that index its messages, (0, 0) without any.
        is_cut: whether the file ends within it.
    """

    offset: int
    packed_size: int
    size: int
    crc: int
    compression: str
    start_ns: int
    end_ns: int
    counts: ChannelCounts | None = field(default=None, compare=False)
    index: tuple[int, int] = field(default=(0, 0), compare=False)
    is_cut: bool = False


def chunk_of(offset: int, data: bytes, length: int) -> McapChunk:
    """Return the chunk whose record contains `length` bytes, of which `data` is the beginning.

    Args:
        offset: of the contents of the record in the file.

    Raises:
        BrokenRecord: it is none.
    """
    if len(data) < CHUNK_FIELDS.size:
        raise BrokenRecord
    start_ns, end_ns, size, crc, name_size = CHUNK_FIELDS.unpack_from(data)
    begin = CHUNK_FIELDS.size + name_size + 8
    if len(data) < begin:
        raise BrokenRecord
    name = data[CHUNK_FIELDS.size : begin - 8]
    packed_size = int.from_bytes(data[begin - 8 : begin], "little")
    if begin + packed_size != length:
        raise BrokenRecord
    compression = name.decode(errors="replace")
    return McapChunk(offset + begin, packed_size, size, crc, compression, start_ns, end_ns)


def chunk_index_of(fields: RecordFields) -> McapChunk:
    """Return the chunk that a record of the summary describes; its checksum is not in there."""
    start_ns, end_ns, offset, _ = fields.numbers("QQQQ")
    offsets = fields.block()
    if len(offsets) % 10:
        raise BrokenRecord
    (index_size,) = fields.numbers("Q")
    name = fields.block()
    packed_size, size = fields.numbers("QQ")
    compression = name.decode(errors="replace")
    return McapChunk(
        offset + PREFIX.size + CHUNK_FIELDS.size + len(name) + 8,
        packed_size,
        size,
        0,
        compression,
        start_ns,
        end_ns,
        *_counts(offsets, index_size),
    )


def counts_of(counts: Iterable[tuple[int, int]]) -> ChannelCounts:
    """Channels and numbers of messages as an array, which takes less memory than a dictionary."""
    return np.array(list(counts), CHANNEL_COUNTS)


def _counts(offsets: bytes, size: int) -> tuple[ChannelCounts | None, tuple[int, int]]:
    """Return the messages of each channel, and where they are indexed.

    The records of the index follow each other and have 16 bytes a message, so that the offsets of
    these records are enough.

    Args:
        offsets: of these records by channel.
        size: of them all.
    """
    places = sorted((offset, number) for number, offset in struct.iter_unpack("<HQ", offsets))
    if not places:
        return None, (0, 0)
    first = places[0][0]
    ends = [*(offset for offset, _ in places[1:]), first + size]
    counts = [
        (number, (end - offset - INDEX_FIELDS.size) // INDEX_ENTRY.itemsize)
        for (offset, number), end in zip(places, ends, strict=True)
    ]
    is_given = all(0 < count < 1 << 32 for _, count in counts) and first + size < 1 << 63
    if not is_given:  # its writer left out the index
        return counts_of((number, 0) for number, _ in counts), (0, 0)
    return counts_of(counts), (first, size)


class IndexOfMessages(NamedTuple):
    """The records behind a chunk that index its messages.

    Args:
        size: bytes of them.
        counts: channels and their numbers of messages.
        span_ns: times of the first and the last message, None without any.
        is_cut: whether more may follow.
    """

    size: int
    counts: Sequence[tuple[int, int]]
    span_ns: tuple[int, int] | None
    is_cut: bool


def index_in(data: bytes) -> IndexOfMessages:
    """Return the index at the beginning of some bytes."""
    counts: list[tuple[int, int]] = []
    entries: list[bytes] = []
    at, is_cut = 0, True
    while at + INDEX_FIELDS.size <= len(data):
        opcode, length, number, size = INDEX_FIELDS.unpack_from(data, at)
        start, end = at + INDEX_FIELDS.size, at + PREFIX.size + length
        is_cut = opcode == MESSAGE_INDEX and start + size == end > len(data)
        if opcode != MESSAGE_INDEX or start + size != end or is_cut:
            break
        if size:
            counts.append((number, size // INDEX_ENTRY.itemsize))
            entries.append(data[start : end - size % INDEX_ENTRY.itemsize])
        at, is_cut = end, True
    if not entries:
        return IndexOfMessages(at, counts, None, is_cut)
    stamps = np.frombuffer(b"".join(entries), INDEX_ENTRY)["stamp_ns"]
    return IndexOfMessages(at, counts, (int(stamps.min()), int(stamps.max())), is_cut)


def header_of(chunk: McapChunk) -> int:
    """Offset of the contents of its record in the file."""
    return chunk.offset - CHUNK_FIELDS.size - len(chunk.compression.encode()) - 8


def contents_of(chunk: McapChunk, file: BinaryIO) -> tuple[bytes, str]:
    """Return the records of a chunk.

    Returns:
        They, or of a damaged chunk the intact beginning; and what is damaged, "" for nothing and
        for a chunk that is cut off.

    Raises:
        OSError: the file cannot be read.
    """
    if chunk.compression not in COMPRESSIONS:
        return b"", f"the compression {chunk.compression!r} is unsupported"
    if max(chunk.size, chunk.packed_size) > MAX_BYTES:
        return b"", f"it claims {_spaced(chunk.size)} bytes, the limit is {_spaced(MAX_BYTES)}"
    file.seek(chunk.offset)
    data, fault = unpack(file.read(chunk.packed_size), chunk.compression, chunk.size)
    if chunk.is_cut:
        return data, ""
    if not fault and len(data) != chunk.size:
        fault = f"it has {_spaced(len(data))} of {_spaced(chunk.size)} bytes"
    if not fault and chunk.crc and crc32(data) != chunk.crc:
        return b"", "its checksum is wrong"
    return data, fault


def _spaced(number: int) -> str:
    return f"{number:,}".replace(",", " ")


class ChunkContent(msgspec.Struct, frozen=True):
    """Messages in the order of the file.

    Args:
        data: in which they are.
        numbers: uint16 (N,), of their channels.
        stamps: uint64 (N,), times of recording in ns.
        starts, ends: offsets of each in the data, N each.
        left_out: numbers of the channels whose messages are missing here.
    """

    data: bytes
    numbers: npt.NDArray[np.uint16]
    stamps: npt.NDArray[np.uint64]
    starts: Sequence[int]
    ends: Sequence[int]
    left_out: Sequence[int] = ()

    def small(self) -> ChunkContent:
        """Return the messages of the channels that have small ones only."""
        sizes = np.subtract(self.ends, self.starts, dtype=np.int64)
        left_out = np.unique(self.numbers[sizes > SMALL])
        if not len(left_out):
            return self
        remaining = np.flatnonzero(~np.isin(self.numbers, left_out))
        rows = remaining.tolist()
        bounds = [0, *itertools.accumulate(sizes[remaining].tolist())]
        return ChunkContent(
            b"".join(self.data[self.starts[row] : self.ends[row]] for row in rows),
            self.numbers[remaining],
            self.stamps[remaining],
            bounds[:-1],
            bounds[1:],
            left_out.tolist(),
        )
