"""Writing of MCAP files, in the layout of rosbag2."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import BinaryIO, cast

from webviz.data.messages.typestore import is_idl
from webviz.data.recordings.recording import RecordedChannel

CHUNK_BYTES = 1 << 20
"""Unpacked, as the readers of MCAP expect."""


class McapFile:
    """A new MCAP file. What was flushed is whole, even if the program ends without `close`.

    Args:
        path: of the file, which must not exist.
        library: the name of the program, for the header.

    Raises:
        OSError: it cannot be made or written, here and in the methods.
    """

    def __init__(self, path: Path, library: str) -> None:
        self.path = path
        self.counts: dict[RecordedChannel, int] = {}
        """Messages by channel."""
        self.span_ns: tuple[int, int] | None = None
        """Stamps of the first and the last message."""
        self._numbers: dict[RecordedChannel, int] = {}
        self._schemas: dict[tuple[str, str], int] = {}
        from mcap.writer import CompressionType, Writer  # here, as it takes 0.1 s

        self._stream = _Stream(path)
        self._writer = Writer(cast(BinaryIO, self._stream), CHUNK_BYTES, CompressionType.ZSTD)
        self._writer.start("ros2", library)

    @property
    def size(self) -> int:
        """Bytes written so far."""
        return self._stream.tell()

    def add(self, channel: RecordedChannel, stamp_ns: int, data: bytes) -> None:
        """Append a message.

        Args:
            channel: of its topic, type and QoS.
            stamp_ns: time of recording.
            data: the serialised message.
        """
        number = self._numbers.get(channel)
        if number is None:
            number = self._numbers[channel] = self._register(channel)
        count = self.counts.get(channel, 0)
        self._writer.add_message(number, stamp_ns, data, stamp_ns, count)
        self.counts[channel] = count + 1
        first_ns, last_ns = self.span_ns or (stamp_ns, stamp_ns)
        self.span_ns = min(first_ns, stamp_ns), max(last_ns, stamp_ns)

    def flush(self) -> None:
        """Write all messages to the disk."""
        self._writer.flush()

    def close(self, *, is_whole: bool = True) -> None:
        """Close the file.

        Args:
            is_whole: write the index. Readers of a file without it, as of a full disk, search it.
        """
        try:
            if is_whole:
                self._writer.finish()
        finally:
            self._stream.close()

    def _register(self, channel: RecordedChannel) -> int:
        key = channel.type, channel.definition
        schema = self._schemas.get(key)
        if schema is None:
            text = channel.definition.encode()
            encoding = "ros2idl" if is_idl(channel.definition) else "ros2msg"
            schema = self._writer.register_schema(channel.type, encoding if text else "", text)
            self._schemas[key] = schema
        metadata = {"offered_qos_profiles": channel.profiles}
        return self._writer.register_channel(channel.topic, channel.encoding, schema, metadata)


class _Stream:
    """A file that is written at once: what a full disk takes only in part is removed again."""

    def __init__(self, path: Path) -> None:
        self._file = path.open("xb", buffering=0)
        self._position = 0

    def write(self, data: bytes) -> int:
        """Append all of the data, or none of it."""
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[self._file.write(rest) :]
        except OSError:
            with contextlib.suppress(OSError):
                self._file.truncate(self._position)
            raise
        self._position += len(data)
        return len(data)

    def tell(self) -> int:
        """Bytes written so far."""
        return self._position

    def flush(self) -> None:
        """Do nothing, as everything is written already."""

    def close(self) -> None:
        """Close the file."""
        self._file.close()
