"""MCAP files: messages in compressed chunks, with an index at the end if recording was ended."""

from __future__ import annotations

import heapq
import itertools
from array import array
from collections import deque
from collections.abc import Collection, Iterator, Sequence, Set
from pathlib import Path

import numpy as np
import numpy.typing as npt

from webviz.data.recordings.mcap_chunks import (
    INDEX_ENTRY,
    INDEX_FIELDS,
    ChunkContent,
    McapChunk,
    contents_of,
)
from webviz.data.recordings.mcap_index import McapIndex
from webviz.data.recordings.mcap_records import (
    CHANNEL,
    FOREVER_NS,
    MESSAGE,
    MESSAGE_FIELDS,
    PREFIX,
    SCHEMA,
)
from webviz.data.recordings.recording import (
    Counts,
    Losses,
    RecordedChannel,
    RecordedMessage,
    TimeParts,
)
from webviz.data.recordings.set_back import LEAST_NS, SetBack, set_back_in
from webviz.data.recordings.unpacking import MAX_BYTES, unpack_message


class ChunkTimes:
    """Finds chunks without looking at each, as a file of gigabytes has tens of thousands.

    Args:
        chunks: of a file, the first one first.
    """

    def __init__(self, chunks: Sequence[McapChunk]) -> None:
        self._starts = np.array([chunk.start_ns for chunk in chunks], np.uint64)
        self._ends = np.array([chunk.end_ns for chunk in chunks], np.uint64)
        self._from_end = np.argsort(self._ends, kind="stable")[::-1]
        self._unknown = np.array([chunk.counts is None for chunk in chunks], bool)
        """Chunks that may have messages of any channel."""
        self._by_channel = _by_channel(chunks)

    def within(self, numbers: Set[int], start_ns: int, end_ns: int, sign: int) -> Sequence[int]:
        """Return the chunks that may have messages of channels within a span, both ends included.

        Args:
            numbers: of the channels.
            start_ns, end_ns: the span.
            sign: 1 for the chunk that starts first, -1 for the one that ends last at the front.

        Returns:
            Indices of chunks.
        """
        is_inside = self._unknown.copy()
        for number in self._by_channel.keys() & numbers:
            is_inside[self._by_channel[number]] = True
        is_inside &= (self._starts <= end_ns) & (self._ends >= start_ns)
        if sign > 0:
            return np.flatnonzero(is_inside).tolist()
        return self._from_end[is_inside[self._from_end]].tolist()


def _by_channel(chunks: Sequence[McapChunk]) -> dict[int, npt.NDArray[np.int64]]:
    """Return the indices of the chunks that have messages of a channel, by its number."""
    counts = [(index, chunk.counts) for index, chunk in enumerate(chunks)]
    present = [(index, each["channel"]) for index, each in counts if each is not None]
    if not present:
        return {}
    numbers = np.concatenate([each for _, each in present])
    sizes = [len(each) for _, each in present]
    owners = np.repeat(np.array([index for index, _ in present], np.int64), sizes)
    order = np.argsort(numbers, kind="stable")
    channel_numbers, firsts = np.unique(numbers[order], return_index=True)
    parts = np.split(owners[order], firsts[1:])
    return dict(zip(channel_numbers.tolist(), parts, strict=True))


MAX_INDEX = 64 << 20
"""Bytes of the index of messages that a histogram reads, 16 for each message. Real recorders close
chunks so often that most lie within one part of the span."""
MAX_REMEMBERED = 32 << 20
"""Bytes of messages that are kept of the last chunks."""
MAX_JUMPS = 10
"""Chunks that begin before the one before them ends, of which the messages are looked at."""
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
        self._path = path
        self._file = path.open("rb")
        try:
            index = McapIndex(self._file, path, self.losses)
        except BaseException:
            self._file.close()
            raise
        self._numbers = index.channels()
        self.channels = tuple(dict.fromkeys(self._numbers.values()))
        in_order = index.chunks
        self._chunks = sorted(in_order, key=lambda chunk: chunk.start_ns)
        self._times = ChunkTimes(self._chunks)
        self._contents: dict[int, ChunkContent] = {}
        """Contents of the last chunks by their offset, the newest at the end; see `_content`."""
        self._remembered = 0
        """Bytes of them."""
        self.span_ns = None
        if set_back := self._set_back(in_order):
            self.losses.notes.append(set_back.note(path.name, self._chunks[0].start_ns))
        if self._chunks:
            self.span_ns = (
                self._chunks[0].start_ns,
                max(min(chunk.end_ns, FOREVER_NS) for chunk in self._chunks),
            )

    def messages(
        self, channels: Collection[RecordedChannel], start_ns: int, end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.messages`."""
        return self._read(channels, start_ns, end_ns)

    def newest(
        self, channels: Collection[RecordedChannel], end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.newest`."""
        return self._read(channels, 0, end_ns, is_backwards=True)

    def newest_stamps(self, channels: Collection[RecordedChannel], end_ns: int) -> Iterator[int]:
        """`Recording.newest_stamps`, of chunks without an index by their messages."""
        numbers = {number for number, each in self._numbers.items() if each in channels}
        pending = deque(self._times.within(numbers, 0, end_ns, -1))
        heap: list[int] = []
        """Negative, as a heap: times of the chunks so far."""
        while pending or heap:
            while pending and not (heap and self._chunks[pending[0]].end_ns <= -heap[0]):
                for stamp_ns in self._stamps(self._chunks[pending.popleft()], numbers):
                    if stamp_ns <= end_ns:
                        heapq.heappush(heap, -stamp_ns)
            if heap:
                yield -heapq.heappop(heap)

    @property
    def used(self) -> frozenset[RecordedChannel]:
        """`Recording.used`."""
        numbers = set[int]()
        for chunk in self._chunks:
            if chunk.counts is None:
                return frozenset(self.channels)
            numbers.update(chunk.counts["channel"].tolist())
        return frozenset(self._numbers[number] for number in numbers if number in self._numbers)

    def histogram(self, parts: TimeParts) -> dict[RecordedChannel, Counts]:
        """`Recording.histogram`, by the counts of chunks, and of long chunks by their index."""
        table = np.zeros((1 << 16, parts.count), np.int64)  # only rows that are used take memory
        left = MAX_INDEX
        with self._path.open("rb") as file:
            for chunk in self._chunks:
                if chunk.counts is None:
                    continue
                offset, size = chunk.index
                first, last = parts.part_of(np.array([chunk.start_ns, chunk.end_ns], np.uint64))
                if first == last:
                    table[chunk.counts["channel"], first] += chunk.counts["count"]
                elif 0 < size <= left:
                    left -= size
                    file.seek(offset)
                    _count_entries(file.read(size), table, parts)
                else:
                    share = np.linspace(0.0, 1.0, last - first + 2)
                    until = np.outer(chunk.counts["count"], share).round().astype(np.int64)
                    table[chunk.counts["channel"], first : last + 1] += np.diff(until)
        histogram: dict[RecordedChannel, Counts] = {}
        for number, channel in self._numbers.items():
            before = histogram.get(channel)
            histogram[channel] = table[number] if before is None else before + table[number]
        return histogram

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _read(
        self,
        channels: Collection[RecordedChannel],
        start_ns: int,
        end_ns: int,
        is_backwards: bool = False,
    ) -> Iterator[RecordedMessage]:
        """Yield the messages of some channels within a span, by time or against it."""
        sign = -1 if is_backwards else 1
        numbers = {number for number, each in self._numbers.items() if each in channels}
        is_wanted = np.zeros(1 << 16, bool)
        is_wanted[list(numbers)] = True
        pending = deque(self._times.within(numbers, start_ns, end_ns, sign))
        opened: list[tuple[int, int, RecordedMessage, Iterator[RecordedMessage], int]] = []
        size = 0
        while pending or opened:
            while pending:
                chunk = self._chunks[pending[0]]
                is_later = opened and _first(chunk, sign) > opened[0][0]
                if is_later or (opened and size + chunk.size > MAX_OPEN):
                    break
                pending.popleft()
                entries = self._entries(chunk, is_wanted, start_ns, end_ns, sign)
                if entry := next(entries, None):
                    size += chunk.size
                    place = (sign * entry.stamp_ns, sign * chunk.offset, entry, entries, chunk.size)
                    heapq.heappush(opened, place)
            if not opened:
                continue
            _, place_of_chunk, entry, entries, own_size = opened[0]
            yield entry
            if following := next(entries, None):
                key = sign * following.stamp_ns
                heapq.heapreplace(opened, (key, place_of_chunk, following, entries, own_size))
            else:
                heapq.heappop(opened)
                size -= own_size

    def _stamps(self, chunk: McapChunk, numbers: Set[int]) -> Iterator[int]:
        """Yield the times of the messages of some channels in a chunk."""
        offset, size = chunk.index
        if not 0 < size <= MAX_INDEX:
            is_wanted = np.zeros(1 << 16, bool)
            is_wanted[list(numbers)] = True
            content = self._content(chunk, is_wanted)
            yield from content.stamps[is_wanted[content.numbers]].tolist()
            return
        self._file.seek(offset)
        for number, stamps in _indexed(self._file.read(size)):
            if number in numbers:
                yield from stamps.tolist()

    def _set_back(self, in_order: Sequence[McapChunk]) -> SetBack | None:
        """Return a jump of the clock between chunks in the order of the file, or within a chunk.

        Files that have their topics one after the other have none: only the times of one channel
        count.
        """
        pairs = (
            (before, after)
            for before, after in itertools.pairwise(in_order)
            if before.end_ns - after.start_ns > LEAST_NS
        )
        for before, after in itertools.islice(pairs, MAX_JUMPS):
            contents = [self._unpacked(chunk) for chunk in (before, after)]
            numbers = np.concatenate([content.numbers for content in contents])
            stamps = np.concatenate([content.stamps for content in contents])
            for number in np.unique(numbers).tolist():
                if set_back := set_back_in(stamps[numbers == number]):
                    return set_back
        return None

    def _entries(
        self,
        chunk: McapChunk,
        is_wanted: npt.NDArray[np.bool_],
        start_ns: int,
        end_ns: int,
        sign: int,
    ) -> Iterator[RecordedMessage]:
        """Yield the wanted messages of a chunk by time, against it with a sign of -1."""
        content = self._content(chunk, is_wanted)
        stamps = content.stamps
        inside = is_wanted[content.numbers] & (stamps >= start_ns) & (stamps <= end_ns)
        rows = np.flatnonzero(inside)
        rows = rows[np.argsort(stamps[rows], kind="stable")][::sign]
        for row in rows.tolist():
            channel = self._numbers[int(content.numbers[row])]
            packed = content.data[content.starts[row] : content.ends[row]]
            message, fault = unpack_message(packed, channel.encoding)
            if fault:
                self.losses.skipped[chunk.offset] = f"a message in it: {fault}"
            else:
                yield RecordedMessage(channel, int(stamps[row]), message)

    def _content(self, chunk: McapChunk, is_wanted: npt.NDArray[np.bool_]) -> ChunkContent:
        """Return the messages of a chunk.

        The small ones of the last chunks are remembered: a seek reads the transforms of many chunks
        that are full of images or clouds, and the next seek is often near.
        """
        cached = self._contents.pop(chunk.offset, None)
        self._remembered -= len(cached.data) if cached else 0
        if cached is None or any(is_wanted[number] for number in cached.left_out):
            content = self._unpacked(chunk)
            cached = content.small()
        else:
            content = cached
        self._contents[chunk.offset] = cached
        self._remembered += len(cached.data)
        while len(self._contents) > 1 and self._remembered > MAX_REMEMBERED:
            self._remembered -= len(self._contents.pop(next(iter(self._contents))).data)
        return content

    def _unpacked(self, chunk: McapChunk) -> ChunkContent:
        """Unpack a chunk and find its messages."""
        data, fault = contents_of(chunk, self._file)
        numbers, stamps, starts, ends = array("H"), array("Q"), array("Q"), array("Q")
        at = 0
        while at + PREFIX.size <= len(data):
            opcode, length = PREFIX.unpack_from(data, at)
            start = at + PREFIX.size
            at = start + length
            if at > len(data) or opcode not in (SCHEMA, CHANNEL, MESSAGE):
                break
            if opcode == MESSAGE and length >= MESSAGE_FIELDS.size:
                number, _, stamp_ns, _ = MESSAGE_FIELDS.unpack_from(data, start)
                if number in self._numbers:
                    numbers.append(number)
                    stamps.append(stamp_ns)
                    starts.append(start + MESSAGE_FIELDS.size)
                    ends.append(at)
                else:
                    fault = "a message in it is of an unknown channel"
        if at != len(data) and not chunk.is_cut:
            fault = fault or "a record in it is damaged"
        if fault:
            self.losses.skipped[chunk.offset] = fault
        return ChunkContent(
            data, np.frombuffer(numbers, np.uint16), np.frombuffer(stamps, np.uint64), starts, ends
        )


def _first(chunk: McapChunk, sign: int) -> int:
    """Return the least key of the messages of a chunk."""
    return chunk.start_ns if sign > 0 else -chunk.end_ns


def _count_entries(index: bytes, table: npt.NDArray[np.int64], parts: TimeParts) -> None:
    """Add the messages of a chunk to the rows of their channels.

    Args:
        index: the records that index them.
        table: rows by number of channel, and columns by part.
        parts: of the span.
    """
    for number, stamps in _indexed(index):
        np.add.at(table[number], parts.part_of(stamps), 1)


def _indexed(index: bytes) -> Iterator[tuple[int, npt.NDArray[np.uint64]]]:
    """Yield channels and the times of their messages, uint64 (N,), by the index of a chunk."""
    at = 0
    while at + INDEX_FIELDS.size <= len(index):
        _, length, number, size = INDEX_FIELDS.unpack_from(index, at)
        entries = index[at + INDEX_FIELDS.size : at + INDEX_FIELDS.size + size]
        entries = entries[: len(entries) // INDEX_ENTRY.itemsize * INDEX_ENTRY.itemsize]
        yield number, np.frombuffer(entries, INDEX_ENTRY)["stamp_ns"]
        at += PREFIX.size + length
