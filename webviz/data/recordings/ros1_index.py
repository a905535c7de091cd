"""Places of the messages of a ROS 1 bag: by the index behind each chunk, or by reading the chunk.

The index at the end of a file is not needed: recorders write that of a chunk right behind it, so
that a bag whose end is missing has all but the last.
"""

from __future__ import annotations

import bz2
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np
import numpy.typing as npt

from webviz.data.recordings.recording import (
    END_MISSING,
    BrokenRecord,
    Losses,
    RecordingError,
    TextAllowance,
)
from webviz.data.recordings.unpacking import MAX_BYTES, unpack

MESSAGE, BAG, INDEX, CHUNK, CHUNK_INFO, CONNECTION = (bytes([op]) for op in range(2, 8))
"""Kinds of records, in their field `op`."""
MAX_FIELDS = 1 << 16
"""Bytes of the fields of a record; real ones have under 300."""
SIZE = 4
"""Bytes of the size before fields, before each field, and before the data."""


class Ros1Record(NamedTuple):
    """The fields of a record, and where its data begins and ends."""

    fields: Mapping[bytes, bytes]
    start: int
    end: int

    @property
    def kind(self) -> bytes:
        """One of `MESSAGE`, `BAG`, `INDEX`, `CHUNK`, `CHUNK_INFO` and `CONNECTION`."""
        return self.fields.get(b"op", b"")

    def number(self, name: bytes) -> int:
        """Return an unsigned field, 0 if it is missing."""
        return number_of(self.fields.get(name, b""))

    def text(self, name: bytes) -> str:
        """Return a field, "" if it is missing."""
        return self.fields.get(name, b"").decode(errors="replace")


def number_of(data: bytes) -> int:
    """Return an unsigned number."""
    return int.from_bytes(data, "little")


def fields_of(data: bytes) -> dict[bytes, bytes]:
    """Return named fields, see https://wiki.ros.org/Bags/Format/2.0.

    Raises:
        BrokenRecord: they are damaged.
    """
    header_fields: dict[bytes, bytes] = {}
    at = 0
    while at < len(data):
        start = at + SIZE
        at = start + number_of(data[at:start])
        name, sign, value = data[start:at].partition(b"=")
        if not sign or at > len(data):
            raise BrokenRecord
        header_fields[name] = value
    return header_fields


def record_in(data: bytes, at: int) -> Ros1Record:
    """Return the record at an offset of an unpacked chunk.

    Raises:
        BrokenRecord: it is damaged, or cut off.
    """
    start = at + SIZE
    end = start + number_of(data[at:start])
    if not start < end <= min(len(data) - SIZE, start + MAX_FIELDS):
        raise BrokenRecord
    length = number_of(data[end : end + SIZE])
    record = Ros1Record(fields_of(data[start:end]), end + SIZE, end + SIZE + length)
    if record.end > len(data):
        raise BrokenRecord
    return record


MAX_DESCRIPTION = 16 << 20
"""Bytes of the description of a connection."""
MIN_DESCRIPTION = 256
"""Bytes that a connection counts at least, for what is kept of it."""
MAX_SEARCHED = 64 << 20
"""Bytes in which the next chunk is searched behind damaged records."""
PLACES = np.dtype([("stamp_ns", "u8"), ("chunk", "i8"), ("offset", "u4")])
"""Places of messages: time, offset of the chunk in the file, and offset in the unpacked chunk."""
_ENTRIES = np.dtype([("sec", "<u4"), ("nanosec", "<u4"), ("offset", "<u4")])
"""Entries of the index behind a chunk."""
_BEGINNING = re.compile(rb"compression=|op=\x05|size=")
"""A field with which a chunk may begin, behind the sizes of the fields and of this one."""

Places = npt.NDArray[np.void]


class Ros1Connection(NamedTuple):
    """A publisher of a topic."""

    topic: str
    type: str
    definition: str
    is_latched: bool


class Ros1Chunk(NamedTuple):
    """A chunk of messages: its data in the file, and how they are compressed."""

    offset: int
    size: int
    compression: str


class Ros1Index:
    """Connections, chunks and places of the messages of a file.

    Args:
        file: opened for reading.
        path: of it, for errors.
        losses: to note what is damaged.

    Raises:
        RecordingError: the file is of another format, or encrypted.
        OSError: it cannot be read.

    Attributes:
        connections: by their numbers.
    """

    def __init__(self, file: BinaryIO, path: Path, losses: Losses) -> None:
        self.connections: dict[int, Ros1Connection] = {}
        self._file = file
        self._size = os.fstat(file.fileno()).st_size
        self._losses = losses
        self._allowance = TextAllowance()
        self._left_to_search = MAX_SEARCHED
        self._chunks: dict[int, Ros1Chunk] = {}
        """Chunks by their offset in the file."""
        self._places: dict[int, list[Places]] = {}
        """Places by connection, in the order of the file."""
        self._walk(self._begin(path))
        for number, (places, *_) in self._places.items():
            if number not in self.connections:  # they are repeated at the end, which is missing
                self._look_into(int(places["chunk"][0]))

    def places(self, number: int) -> Places:
        """Return the places of the messages of a connection, in the order of the file."""
        return np.concatenate([np.empty(0, PLACES), *self._places.get(number, ())])

    def unpacked(self, offset: int) -> bytes:
        """Return the chunk at an offset of the file, or what can be unpacked of it."""
        chunk = self._chunks[offset]
        packed = self._read(chunk.offset, min(chunk.size, MAX_BYTES))
        if chunk.compression == "bz2":
            return _unpacked_bz2(packed)
        return unpack(packed, "lz4" if chunk.compression == "lz4" else "", MAX_BYTES)[0]

    def _read(self, offset: int, size: int) -> bytes:
        """Return bytes of the file, fewer behind its end."""
        self._file.seek(min(offset, self._size))
        return self._file.read(min(size, self._size))

    def _begin(self, path: Path) -> int:
        """Read the head of a file, and return the offset of the record behind it."""
        line = self._read(0, 64).split(b"\n", 1)[0]
        version = line.decode(errors="replace").removeprefix("#ROSBAG V")
        if version != "2.0":
            raise RecordingError(f"{path} has format {version!r}: run `rosbag reindex {path}`.")
        start = len(line) + 1
        try:
            head = self._record(start)
        except BrokenRecord:
            if start >= self._size:
                self._miss_end()
            return start
        if head.fields.get(b"encryptor"):
            raise RecordingError(f"{path} is encrypted: run `rosbag decrypt {path}`.")
        if not 0 < head.number(b"index_pos") <= self._size:
            self._miss_end()
        return head.end

    def _record(self, at: int) -> Ros1Record:
        """Return the record at an offset; the data of a chunk may be cut off.

        Raises:
            BrokenRecord: it is damaged, or cut off.
        """
        size = number_of(self._read(at, SIZE))
        header = self._read(at + SIZE, min(size, MAX_FIELDS) + SIZE)
        if len(header) != size + SIZE:
            raise BrokenRecord
        start = at + SIZE + len(header)
        record = Ros1Record(fields_of(header[:size]), start, start + number_of(header[size:]))
        if record.kind not in (BAG, INDEX, CHUNK, CHUNK_INFO, CONNECTION):
            raise BrokenRecord
        if record.end > self._size and record.kind != CHUNK:
            raise BrokenRecord
        return record

    def _walk(self, at: int) -> None:
        """Note one record after the other."""
        chunk: int | None = None
        indexed: list[tuple[int, Places]] = []
        while at < self._size:
            try:
                record = self._record(at)
            except BrokenRecord:
                self._end_chunk(chunk, ())
                chunk, indexed = None, []
                if (next_at := self._next_chunk(at + 1)) is None:
                    self._miss_end()
                    break
                self._losses.skipped[at] = "a record is damaged"
                at = next_at
                continue
            if record.kind == INDEX and chunk is not None:
                indexed.append(self._indexed(record, chunk))
            else:
                self._end_chunk(chunk, indexed)
                chunk, indexed = None, []
            if record.kind == CHUNK:
                chunk, size = at, min(record.end, self._size) - record.start
                self._chunks[at] = Ros1Chunk(record.start, size, record.text(b"compression"))
            elif record.kind == CONNECTION:
                size = min(record.end - record.start, MAX_DESCRIPTION)
                self._learn(record, self._read(record.start, size))
            if record.end > self._size:
                self._miss_end()
            at = record.end
        self._end_chunk(chunk, ())  # its index may be cut off

    def _next_chunk(self, at: int) -> int | None:
        """Return the offset of the next chunk, None without one."""
        while at < self._size and self._left_to_search > 0:
            block = self._read(at, 1 << 20)
            self._left_to_search -= len(block)
            for match in _BEGINNING.finditer(block):
                start = at + match.start() - 2 * SIZE
                try:
                    if start >= at and self._record(start).kind == CHUNK:
                        return start
                except BrokenRecord:
                    pass
            at += max(len(block) - 64, 64)  # a beginning may lie between two blocks
        return None

    def _indexed(self, record: Ros1Record, chunk: int) -> tuple[int, Places]:
        """Return a connection, and the places of its messages in a chunk, as an index says."""
        data = self._read(record.start, record.end - record.start)
        whole = len(data) // _ENTRIES.itemsize * _ENTRIES.itemsize
        entries = np.frombuffer(data[:whole], _ENTRIES)
        entries_places = np.empty(len(entries), PLACES)
        entries_places["stamp_ns"] = entries["sec"].astype(np.uint64) * 10**9 + entries["nanosec"]
        entries_places["chunk"], entries_places["offset"] = chunk, entries["offset"]
        return record.number(b"conn"), entries_places

    def _end_chunk(self, chunk: int | None, indexed: Sequence[tuple[int, Places]]) -> None:
        """Note the messages of a chunk, by its index if it has one."""
        if chunk is not None:
            for number, places in indexed or self._look_into(chunk):
                if len(places):
                    self._places.setdefault(number, []).append(places)

    def _look_into(self, chunk: int) -> list[tuple[int, Places]]:
        """Return the places of the messages of a chunk by connection, and learn its connections."""
        by_number: dict[int, list[tuple[int, int, int]]] = {}
        data, at = self.unpacked(chunk), 0
        try:
            while at < len(data):
                record = record_in(data, at)
                if record.kind == CONNECTION:
                    self._learn(record, data[record.start : record.end])
                elif record.kind == MESSAGE:
                    time = record.number(b"time")
                    stamp_ns = (time & 0xFFFFFFFF) * 10**9 + (time >> 32 & 0xFFFFFFFF)
                    by_number.setdefault(record.number(b"conn"), []).append((stamp_ns, chunk, at))
                at = record.end
        except BrokenRecord:
            if END_MISSING not in self._losses.others:
                self._losses.skipped[chunk] = "its chunk is damaged"
        return [(number, np.array(places, PLACES)) for number, places in by_number.items()]

    def _learn(self, record: Ros1Record, data: bytes) -> None:
        """Note a connection; a damaged one lacks its type."""
        number = record.number(b"conn")
        if number in self.connections or not self._allowance.take(MIN_DESCRIPTION, len(data)):
            return
        try:
            described = Ros1Record(fields_of(data), 0, 0)
        except BrokenRecord:
            return
        self.connections[number] = Ros1Connection(
            record.text(b"topic"),
            described.text(b"type"),
            described.text(b"message_definition"),
            described.text(b"latching") == "1",
        )

    def _miss_end(self) -> None:
        if END_MISSING not in self._losses.others:
            self._losses.others.append(END_MISSING)


def _unpacked_bz2(data: bytes) -> bytes:
    try:
        return bz2.BZ2Decompressor().decompress(data, MAX_BYTES)
    except (OSError, EOFError):
        return b""
