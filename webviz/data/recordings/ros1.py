"""ROS 1 bags (.bag), whose messages are converted to those of ROS 2."""

from __future__ import annotations

import bisect
import heapq
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

import numpy as np

from webviz.data.messages.errors import MessageError
from webviz.data.messages.ros1 import Ros1Type
from webviz.data.recordings.recording import (
    Counts,
    Losses,
    RecordedChannel,
    RecordedMessage,
    TimeParts,
)
from webviz.data.recordings.ros1_index import Places, Ros1Connection, Ros1Index

LATCHED = "- {reliability: reliable, durability: transient_local, depth: 1}"
VOLATILE = "- {reliability: reliable, durability: volatile}"
MAX_CHUNKS = 8
"""Unpacked chunks that are kept; recorders close them at 768 kB."""

MAX_CONVERTED = 32 << 20
"""Bytes of converted messages that are kept: a seek often reads those of the one before."""
MAX_SMALL = 64 << 10
"""Bytes of a message that is kept."""

_Place = tuple[int, int, int]
"""Place of a message: time, offset of its chunk in the file, and its offset in the chunk."""


class Ros1Recording:
    """The messages of a ROS 1 bag.

    Args:
        path: of the file.

    Raises:
        RecordingError: it is of another format, or encrypted.
        OSError: it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self.losses = Losses("message", "skipped")
        self._file = path.open("rb")
        try:
            self._index = Ros1Index(self._file, path, self.losses)
        except BaseException:
            self._file.close()
            raise
        self._chunks: dict[int, bytes] = {}
        self._converted: dict[_Place, RecordedMessage] = {}
        """The last small ones by their places, the newest at the end."""
        self._converted_bytes = 0
        self._types: dict[RecordedChannel, Ros1Type] = {}
        self._places: dict[RecordedChannel, Places] = {}
        """Places by time."""
        for number, connection in self._index.connections.items():
            self._note(connection, self._index.places(number))
        self.channels = tuple(self._places)
        spans = [places["stamp_ns"][[0, -1]] for places in self._places.values() if len(places)]
        self.span_ns = (int(np.min(spans)), int(np.max(spans))) if spans else None

    def messages(
        self, channels: Collection[RecordedChannel], start_ns: int, end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.messages`."""
        streams = [
            self._within(channel, start_ns, end_ns) for channel in self._own_channels(channels)
        ]
        for channel, place in heapq.merge(*streams, key=_stamp):
            if entry := self._entry(channel, place):
                yield entry

    def newest(
        self, channels: Collection[RecordedChannel], end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.newest`."""
        streams = [self._within(channel, 0, end_ns, -1) for channel in self._own_channels(channels)]
        for channel, place in heapq.merge(*streams, key=_stamp, reverse=True):
            if entry := self._entry(channel, place):
                yield entry

    def newest_stamps(self, channels: Collection[RecordedChannel], end_ns: int) -> Iterator[int]:
        """`Recording.newest_stamps`."""
        streams = [self._within(channel, 0, end_ns, -1) for channel in self._own_channels(channels)]
        return map(_stamp, heapq.merge(*streams, key=_stamp, reverse=True))

    @property
    def used(self) -> frozenset[RecordedChannel]:
        """`Recording.used`."""
        return frozenset(channel for channel, places in self._places.items() if len(places))

    def histogram(self, parts: TimeParts) -> dict[RecordedChannel, Counts]:
        """`Recording.histogram`."""
        histogram: dict[RecordedChannel, Counts] = {}
        for channel, places in self._places.items():
            numbers = parts.part_of(places["stamp_ns"])
            histogram[channel] = np.bincount(numbers, minlength=parts.count).astype(np.int64)
        return histogram

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _note(self, connection: Ros1Connection, places: Places) -> None:
        """Note a publisher of a topic; its messages are those of its channel."""
        topic = "/" + "/".join(filter(None, connection.topic.split("/")))
        name = connection.type
        name = name if "/msg/" in name else name.replace("/", "/msg/", 1)
        profile = LATCHED if connection.is_latched else VOLATILE
        try:
            type_ = Ros1Type(name, connection.definition)
            definition = type_.definition()
            channel = RecordedChannel(topic, type_.name, "cdr", definition, profile)
        except MessageError:
            channel = RecordedChannel(topic, name, "ros1", "", profile)
        else:
            self._types[channel] = type_
        if channel in self._places:
            places = np.concatenate([self._places[channel], places])
        self._places[channel] = places[np.argsort(places["stamp_ns"], kind="stable")]

    def _own_channels(self, channels: Collection[RecordedChannel]) -> Sequence[RecordedChannel]:
        return [channel for channel in self._types if channel in channels]

    def _within(
        self, channel: RecordedChannel, start_ns: int, end_ns: int, step: int = 1
    ) -> Iterator[tuple[RecordedChannel, _Place]]:
        """Yield the places of the messages of a channel within a span, by time or against it."""
        places = self._places[channel]
        first = bisect.bisect_left(places["stamp_ns"], start_ns)
        last = bisect.bisect_right(places["stamp_ns"], end_ns)
        for index in range(first, last)[::step]:
            yield channel, places[index].item()

    def _entry(self, channel: RecordedChannel, place: _Place) -> RecordedMessage | None:
        """Return a message in the form of ROS 2, None if it is damaged."""
        if (converted := self._converted.get(place)) is not None:
            return converted
        stamp_ns, chunk, at = place
        data = self._chunk(chunk)
        size = int.from_bytes(data[at : at + 4], "little")
        start = at + 4 + size + 4
        length = int.from_bytes(data[start - 4 : start], "little")
        message = data[start : start + length]
        try:
            if start > len(data) or len(message) < length:
                self.losses.skipped[place] = "its chunk is damaged"
                return None
            message_read = RecordedMessage(channel, stamp_ns, self._types[channel].to_cdr(message))
        except MessageError as error:
            self.losses.skipped[place] = str(error).rstrip(".")
            return None
        if len(message_read.data) <= MAX_SMALL:
            self._converted[place] = message_read
            self._converted_bytes += len(message_read.data)
            while self._converted_bytes > MAX_CONVERTED:
                oldest = self._converted.pop(next(iter(self._converted)))
                self._converted_bytes -= len(oldest.data)
        return message_read

    def _chunk(self, position: int) -> bytes:
        """Return the unpacked chunk at an offset of the file, or what can be unpacked of it."""
        if position in self._chunks:
            return self._chunks[position]
        data = self._index.unpacked(position)
        while len(self._chunks) >= MAX_CHUNKS:
            del self._chunks[next(iter(self._chunks))]
        self._chunks[position] = data
        return data


def _stamp(item: tuple[RecordedChannel, _Place]) -> int:
    return item[1][0]
