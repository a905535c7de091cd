"""Offsets of the chunks of an MCAP file: by its summary, or by all of its records without one."""

from __future__ import annotations

import os
import re
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import BinaryIO
from zlib import crc32

import numpy as np

from webviz.data.recordings.mcap_chunks import (
    CHUNK_FIELDS,
    CRC_OFFSET,
    McapChunk,
    chunk_index_of,
    chunk_of,
    contents_of,
    counts_of,
    header_of,
    index_in,
)
from webviz.data.recordings.mcap_records import (
    ATTACHMENT,
    CHANNEL,
    CHUNK,
    CHUNK_INDEX,
    DATA_END,
    DATA_END_SIZE,
    END_SIZE,
    FIRST_PRIVATE_OPCODE,
    FOOTER,
    FOREVER_NS,
    HEADER,
    LAST_OPCODE,
    MAGIC,
    MESSAGE,
    MESSAGE_FIELDS,
    MESSAGE_INDEX,
    METADATA,
    PREFIX,
    SCHEMA,
    STATISTICS,
    McapChannel,
    McapSchema,
    RecordFields,
    channel_of,
    records_of,
    schema_of,
)
from webviz.data.recordings.recording import (
    END_MISSING,
    BrokenRecord,
    Losses,
    RecordedChannel,
    RecordingError,
    TextAllowance,
)

MAX_SUMMARY = 64 << 20
"""Bytes of a summary; an index of 100 GB in chunks of 1 MiB has 10 MB."""
MAX_RECORD = 16 << 20
"""Bytes of a schema or channel."""
INDEX_BYTES = 32 << 10
"""Bytes that are read at first of the index behind a chunk, 16 for each message."""
REGION = 4 << 20
"""Bytes of consecutive messages outside of chunks that are read together."""
MAX_SEARCHED = 64 << 20
"""Bytes in which the next record is searched behind damaged ones."""
MAX_PLAUSIBLE = 1 << 32
"""Length of a record."""
_START = re.compile(rb"[\x03-\x06].{4}\0{4}", re.DOTALL)
"""Perhaps the beginning of a record with less than 4 GiB."""


@dataclass
class _Region:
    """Messages outside of chunks that follow each other."""

    offset: int
    first_ns: int
    last_ns: int
    size: int = 0
    counts: Counter[int] = field(default_factory=Counter[int])


class McapIndex:
    """Schemas, channels and chunks of a file.

    Args:
        file: opened for reading.
        path: of it, for errors.
        losses: to note what is damaged.

    Raises:
        RecordingError: the file is not of ROS 2.
        OSError: it cannot be read.
    """

    def __init__(self, file: BinaryIO, path: Path, losses: Losses) -> None:
        self.chunks: list[McapChunk] = []
        self._file = file
        self._size = os.fstat(file.fileno()).st_size
        self._losses = losses
        self._schemas: dict[int, McapSchema] = {}
        self._channels: dict[int, McapChannel] = {}
        self._allowance = TextAllowance()
        self._left_to_search = MAX_SEARCHED
        self._index_size = INDEX_BYTES
        self._region: _Region | None = None
        profile = self._profile()
        if profile not in ("ros2", ""):
            raise RecordingError(
                f"{path} was recorded by {profile!r}, not by ROS 2: give a bag of "
                "`ros2 bag record`."
            )
        try:
            is_complete = self._read_summary()
        except BrokenRecord:
            is_complete = False
        if not is_complete:
            self.chunks.clear()
            self._scan()

    def channels(self) -> dict[int, RecordedChannel]:
        """All channels by their ids."""
        channels = {}
        for number, (schema, topic, encoding, profiles) in self._channels.items():
            name, definition = self._schemas.get(schema, ("", ""))
            channels[number] = RecordedChannel(topic, name, encoding, definition, profiles)
        return channels

    def _read(self, offset: int, size: int) -> bytes:
        """Return bytes of the file, fewer behind its end, which claims in it may exceed by far."""
        self._file.seek(min(offset, self._size))
        return self._file.read(min(size, self._size))

    def _prefix(self, offset: int) -> tuple[int, int]:
        data = self._read(offset, PREFIX.size)
        if len(data) < PREFIX.size:
            raise BrokenRecord
        return PREFIX.unpack(data)

    def _profile(self) -> str:
        """Return the profile of the file, such as "ros2"; "" if it is damaged."""
        try:
            opcode, length = self._prefix(len(MAGIC))
            if opcode != HEADER or length > MAX_RECORD:
                return ""
            return RecordFields(self._read(len(MAGIC) + PREFIX.size, length)).text()
        except BrokenRecord:
            return ""

    def _read_summary(self) -> bool:
        """Return whether there is an intact summary that names all chunks and channels."""
        end = self._read(max(0, self._size - END_SIZE), END_SIZE)
        if len(end) < END_SIZE or end[-len(MAGIC) :] != MAGIC or end[0] != FOOTER:
            return False
        start, _, checksum = RecordFields(end[PREFIX.size :]).numbers("QQI")
        size = self._size - END_SIZE - start
        if not start or not 0 < size <= MAX_SUMMARY:
            return False
        summary = self._read(start, size)
        # The checksum comprises the footer up to itself.
        covered = summary + end[: PREFIX.size + 16]
        if checksum and crc32(covered) != checksum:
            return False
        chunks, count = self._summarised(summary)
        if not chunks or count not in (None, len(chunks)) or not self._channels:
            return False
        if not checksum and not all(map(self._is_as_summarised, chunks)):
            return False
        self.chunks = [c for c in chunks if c.counts is not None or c.end_ns]
        is_known = np.zeros(1 << 16, bool)
        is_known[list(self._channels)] = True
        return all(is_known[c.counts["channel"]].all() for c in chunks if c.counts is not None)

    def _summarised(self, summary: bytes) -> tuple[list[McapChunk], int | None]:
        """Return the chunks, and how many there must be, None if unknown."""
        chunks: list[McapChunk] = []
        count: int | None = None
        for opcode, fields in records_of(summary):
            if opcode == CHUNK_INDEX:
                chunk = chunk_index_of(fields)
                chunks.append(replace(chunk, crc=self._checksum(chunk)))
            elif opcode == STATISTICS:
                *_, count = fields.numbers("QHIIII")
            else:
                self._learn(opcode, fields)
        return chunks, count

    def _is_as_summarised(self, chunk: McapChunk) -> bool:
        start = header_of(chunk)
        opcode, length = self._prefix(start - PREFIX.size)
        return opcode == CHUNK and chunk == self._chunk(start, length)

    def _checksum(self, chunk: McapChunk) -> int:
        data = self._read(header_of(chunk) + CRC_OFFSET, 4)
        if len(data) < 4:
            raise BrokenRecord
        return int.from_bytes(data, "little")

    def _chunk(self, offset: int, length: int) -> McapChunk:
        """Return the chunk whose record has these contents."""
        chunk = chunk_of(offset, self._read(offset, CHUNK_FIELDS.size + 64), length)
        rest = self._size - chunk.offset
        if rest < chunk.packed_size:
            return replace(chunk, packed_size=rest, is_cut=True)
        return chunk

    def _learn(self, opcode: int, fields: RecordFields) -> None:
        """Note a schema or channel."""
        if opcode == SCHEMA:
            number, schema = schema_of(fields)
            if number not in self._schemas and self._allowance.take(*map(len, schema)):
                self._schemas[number] = schema
        elif opcode == CHANNEL:
            number, channel = channel_of(fields)
            if number not in self._channels and self._allowance.take(*map(len, channel[1:])):
                self._channels[number] = channel

    def _scan(self) -> None:
        """Find all chunks and messages by reading one record after the other."""
        at, is_ended = len(MAGIC), False
        while at + PREFIX.size <= self._size and not is_ended:
            opcode, length = self._prefix(at)
            start = at + PREFIX.size
            try:
                end = self._note(opcode, start, length)
            except BrokenRecord:
                if (next_at := self._next_record(at + 1)) is None:
                    break
                self._losses.skipped[at] = "a record is damaged"
                at = next_at
            else:
                is_ended = opcode == FOOTER
                at = end
        self._end_region()
        if not is_ended:
            self._losses.others.append(END_MISSING)

    def _note(self, opcode: int, start: int, length: int) -> int:
        """Note what a record in the file contains; where the next one begins that says more."""
        if opcode == CHUNK:
            chunk = self._chunk(start, length)
            if indexed := self._indexed(chunk):
                self.chunks.append(indexed)
                return sum(indexed.index)
            self.chunks += self._looked_into(chunk)
            return start + length
        is_known = 0 < opcode <= LAST_OPCODE or opcode >= FIRST_PRIVATE_OPCODE
        is_misplaced = opcode == FOOTER and start != self._size - END_SIZE + PREFIX.size
        if not is_known or is_misplaced or start + length > self._size:
            raise BrokenRecord
        if opcode == MESSAGE_INDEX and length != self._index_length(start):
            raise BrokenRecord  # lest the search goes on within a chunk behind it
        if opcode == MESSAGE:
            self._note_message(start, length)
        elif opcode in (SCHEMA, CHANNEL):
            if length > MAX_RECORD:
                raise BrokenRecord
            self._learn(opcode, RecordFields(self._read(start, length)))
        return start + length

    def _index_length(self, start: int) -> int:
        """Return the length of the index of a channel in a chunk, as its contents say."""
        _, size = RecordFields(self._read(start, 6)).numbers("HI")
        return 6 + size

    def _indexed(self, chunk: McapChunk) -> McapChunk | None:
        """Return the chunk as the records behind it index it, which is quicker than to unpack it.

        Returns:
            None if the index is missing, may be incomplete, contradicts the chunk, or has an
            unknown channel.
        """
        start = chunk.offset + chunk.packed_size
        index = index_in(self._read(start, self._index_size))
        while index.is_cut and start + self._index_size < self._size:
            if self._index_size >= MAX_RECORD:
                return None
            self._index_size *= 2
            index = index_in(self._read(start, self._index_size))
        numbers = {number for number, _ in index.counts}
        is_known = len(numbers) == len(index.counts) and numbers <= self._channels.keys()
        is_same = index.span_ns == (chunk.start_ns, chunk.end_ns)
        if not is_known or not is_same or not self._is_end_of_index(start + index.size):
            return None
        return replace(chunk, counts=counts_of(index.counts), index=(start, index.size))

    def _is_end_of_index(self, at: int) -> bool:
        """Return whether a record begins that follows the index of a chunk.

        Not one of those whose opcode differs from that of an index by one bit.
        """
        try:
            opcode, length = self._prefix(at)
            if opcode == CHUNK:
                self._chunk(at + PREFIX.size, length)
                return True
        except BrokenRecord:
            return False
        return opcode in (ATTACHMENT, METADATA) or (opcode, length) == (DATA_END, DATA_END_SIZE)

    def _note_message(self, start: int, length: int) -> None:
        """Add a message outside of chunks to the region that ends where it begins."""
        data = self._read(start, MESSAGE_FIELDS.size)
        if length < MESSAGE_FIELDS.size:
            raise BrokenRecord
        number, _, stamp_ns, _ = MESSAGE_FIELDS.unpack(data)
        if stamp_ns > FOREVER_NS or not self._is_followed(start + length):
            raise BrokenRecord
        offset, size = start - PREFIX.size, length + PREFIX.size
        region = self._region
        if region is None or region.offset + region.size != offset or region.size >= REGION:
            self._end_region()
            region = self._region = _Region(offset, stamp_ns, stamp_ns)
        region.size += size
        region.first_ns = min(region.first_ns, stamp_ns)
        region.last_ns = max(region.last_ns, stamp_ns)
        region.counts[number] += 1

    def _end_region(self) -> None:
        """Note the messages outside of chunks that were found one after the other."""
        region, self._region = self._region, None
        if region is not None:
            counts = counts_of(region.counts.items())
            span_ns = region.first_ns, region.last_ns
            self.chunks.append(
                McapChunk(region.offset, region.size, region.size, 0, "", *span_ns, counts)
            )

    def _looked_into(self, chunk: McapChunk) -> list[McapChunk]:
        """Return the chunk with the times of its messages, none if it has none.

        Learns its channels.
        """
        data, fault = contents_of(chunk, self._file)
        first_ns, last_ns, counts = FOREVER_NS, -1, Counter[int]()
        try:
            for opcode, fields in records_of(data):
                if opcode == MESSAGE:
                    number, _, stamp_ns = fields.numbers("HIQ")
                    first_ns, last_ns = min(first_ns, stamp_ns), max(last_ns, stamp_ns)
                    counts[number] += 1
                else:
                    self._learn(opcode, fields)
        except BrokenRecord:
            pass  # as other damage, reported by `McapRecording`
        if fault:
            return [chunk]
        if last_ns < 0:
            return []
        channel_counts = counts_of(counts.items())
        return [replace(chunk, start_ns=first_ns, end_ns=last_ns, counts=channel_counts)]

    def _next_record(self, at: int) -> int | None:
        """Return where the next plausible record begins that another follows, None without one."""
        while at < self._size and self._left_to_search > 0:
            block = self._read(at, 1 << 20)
            self._left_to_search -= len(block)
            for match in _START.finditer(block):
                start = at + match.start()
                if self._is_record(start):
                    return start
            at += max(len(block) - PREFIX.size + 1, 1)
        return None

    def _is_record(self, at: int) -> bool:
        try:
            opcode, length = self._prefix(at)
            start = at + PREFIX.size
            if opcode == CHUNK:
                self._chunk(start, length)
            return self._is_followed(start + length)
        except BrokenRecord:
            return False

    def _is_followed(self, at: int) -> bool:
        """Return whether the file ends at an offset, or a plausible record begins."""
        if at == self._size:
            return True
        opcode, length = self._prefix(at)
        return 0 < opcode <= LAST_OPCODE and length < MAX_PLAUSIBLE
