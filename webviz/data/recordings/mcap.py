"""MCAP files: messages in compressed chunks, with an index at the end if recording was ended."""

from __future__ import annotations

import heapq
import struct
from array import array
from collections import deque
from collections.abc import Collection, Iterator
from pathlib import Path

import numpy as np

from webviz.data.recordings.mcap_chunks import McapChunk, contents_of
from webviz.data.recordings.mcap_index import McapIndex
from webviz.data.recordings.mcap_records import (
    CHANNEL,
    FOREVER_NS,
    MESSAGE,
    MESSAGE_FIELDS,
    PREFIX,
    SCHEMA,
)
from webviz.data.recordings.recording import Losses, RecordedChannel, RecordedMessage
from webviz.data.recordings.unpacking import MAX_BYTES

MAX_OPEN = 2 * MAX_BYTES
"""Bytes of unpacked chunks at a time. Of more chunks that overlap, the messages come late."""


class McapRecording:
    """The messages of an MCAP file.

    Args:
        path: of the file.

    Raises:
        RecordingError: it is not of ROS 2.
        OSError: it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self.losses = Losses("chunk", "incomplete")
        self._file = path.open("rb")
        try:
            index = McapIndex(self._file, path, self.losses)
        except BaseException:
            self._file.close()
            raise
        self._numbers = index.channels()
        self.channels = tuple(dict.fromkeys(self._numbers.values()))
        self._chunks = sorted(index.chunks, key=lambda chunk: chunk.start_ns)
        self.span_ns = None
        if self._chunks:
            self.span_ns = (
                self._chunks[0].start_ns,
                max(min(chunk.end_ns, FOREVER_NS) for chunk in self._chunks),
            )

    def messages(
        self, channels: Collection[RecordedChannel], start_ns: int, end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.messages`."""
        wanted = {number: each for number, each in self._numbers.items() if each in channels}
        pending = deque(
            chunk
            for chunk in self._chunks
            if chunk.start_ns <= end_ns
            and start_ns <= chunk.end_ns
            and (chunk.channels is None or not chunk.channels.isdisjoint(wanted))
        )
        opened: list[tuple[int, int, RecordedMessage, Iterator[RecordedMessage], int]] = []
        size = 0
        while pending or opened:
            while pending and (not opened or pending[0].start_ns <= opened[0][0]):
                if opened and size + pending[0].size > MAX_OPEN:
                    break
                chunk = pending.popleft()
                entries = self._entries(chunk, wanted, start_ns, end_ns)
                if entry := next(entries, None):
                    size += chunk.size
                    place = (entry.stamp_ns, chunk.offset, entry, entries, chunk.size)
                    heapq.heappush(opened, place)
            if not opened:
                continue
            _, offset, entry, entries, own_size = opened[0]
            yield entry
            if following := next(entries, None):
                place = (following.stamp_ns, offset, following, entries, own_size)
                heapq.heapreplace(opened, place)
            else:
                heapq.heappop(opened)
                size -= own_size

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _entries(
        self, chunk: McapChunk, wanted: dict[int, RecordedChannel], start_ns: int, end_ns: int
    ) -> Iterator[RecordedMessage]:
        """The wanted messages of a chunk by time."""
        data, fault = contents_of(chunk, self._file)
        stamps, places = array("Q"), array("Q")
        at = 0
        while at + PREFIX.size <= len(data):
            opcode, length = PREFIX.unpack_from(data, at)
            start = at + PREFIX.size
            at = start + length
            if at > len(data) or opcode not in (SCHEMA, CHANNEL, MESSAGE):
                break
            if opcode == MESSAGE and length >= MESSAGE_FIELDS.size:
                number, _, stamp_ns, _ = MESSAGE_FIELDS.unpack_from(data, start)
                if number in wanted and start_ns <= stamp_ns <= end_ns:
                    stamps.append(stamp_ns)
                    places.append(start)
                elif number not in self._numbers:
                    fault = "a message in it is of an unknown channel"
        if at != len(data) and not chunk.is_cut:
            fault = fault or "a record in it is damaged"
        if fault:
            self.losses.skipped[chunk.offset] = fault
        for row in np.argsort(np.frombuffer(stamps, np.uint64), kind="stable").tolist():
            start = places[row]
            (length,) = struct.unpack_from("<Q", data, start - 8)
            (number,) = struct.unpack_from("<H", data, start)
            content = data[start + MESSAGE_FIELDS.size : start + length]
            yield RecordedMessage(wanted[number], stamps[row], content)
