"""Long bags made of short ones: the same drive again and again, at later times."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from mcap.writer import CompressionType, Writer

from webviz.data.messages import TFMessage, decode, definition, peek_header
from webviz.data.recordings import RecordedChannel, open_recording

SECOND = 1_000_000_000
TF = "tf2_msgs/msg/TFMessage"
LATCHED = ("/tf_static", "/map", "/robot_description")
CHUNK = 786_432
"""Bytes of a chunk, as rosbag2's default."""


@dataclass(frozen=True)
class Drive:
    """The messages of a short bag.

    Args:
        once: channels and messages that come at the start only, since they are latched.
        channels: of the other messages.
        stamps: uint64 (N,), their times of recording in ns.
        ends: offsets of their ends in `data`.
        data: uint8, of all messages.
        seconds_at: offsets in `data` of the seconds of stamps.
        length_s: duration in whole seconds.
    """

    once: Sequence[tuple[RecordedChannel, int, bytes]]
    channels: Sequence[RecordedChannel]
    stamps: np.ndarray
    ends: Sequence[int]
    data: np.ndarray
    seconds_at: np.ndarray
    length_s: int

    def repeated(self, size: int) -> Iterator[tuple[RecordedChannel, int, bytes]]:
        """The messages of a bag of at least some bytes, by time."""
        yield from self.once
        words = self.seconds_at[:, None] + np.arange(4)
        seconds = self.data[words].view("<u4")
        starts = [0, *self.ends[:-1]]
        for lap in range(-(-size // self.data.size)):
            shift_s = lap * self.length_s
            data = self.data.copy()
            data[words] = (seconds + np.uint32(shift_s)).view(np.uint8)
            stamps = (self.stamps + np.uint64(shift_s * SECOND)).tolist()
            raw = data.tobytes()
            for channel, stamp, start, end in zip(
                self.channels, stamps, starts, self.ends, strict=True
            ):
                yield channel, stamp, raw[start:end]


def drive_of(path: Path) -> Drive:
    """Read a short bag."""
    bag = open_recording(path)
    assert bag.span_ns is not None
    entries = list(bag.messages(bag.channels, *bag.span_ns))
    bag.close()
    latched = {channel for channel in bag.channels if channel.topic in LATCHED}
    moving = [entry for entry in entries if entry.channel not in latched]
    ends = list(itertools.accumulate(len(entry.data) for entry in moving))
    seconds_at = [
        end - len(entry.data) + place
        for entry, end in zip(moving, ends, strict=True)
        for place in _stamps_in(entry.channel.type, entry.data)
    ]
    first_ns, last_ns = bag.span_ns
    return Drive(
        [(e.channel, first_ns, e.data) for e in entries if e.channel in latched],
        [entry.channel for entry in moving],
        np.array([entry.stamp_ns for entry in moving], np.uint64),
        ends,
        np.frombuffer(b"".join(entry.data for entry in moving), np.uint8),
        np.array(seconds_at, np.int64),
        (last_ns - first_ns) // SECOND + 1,
    )


def _stamps_in(type_name: str, data: bytes) -> list[int]:
    """Offsets of the seconds of all stamps that are before the time of recording."""
    if type_name == TF:
        message: TFMessage = decode(TF, data)
        places, at = [], 4
        for each in message.transforms:
            packed = each.stamp_ns // SECOND
            at = data.index(int(packed).to_bytes(4, "little"), at)
            places.append(at)
            at += 8
        return places
    return [4] if peek_header(type_name, data) else []


def write_mcap(path: Path, drive: Drive, size: int) -> None:
    """Write an MCAP file, as `ros2 bag record` does."""
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=CHUNK, compression=CompressionType.NONE)
        writer.start("ros2", "a benchmark")
        schemas: dict[str, int] = {}
        numbers: dict[RecordedChannel, int] = {}
        for channel, stamp, data in drive.repeated(size):
            if channel not in numbers:
                name = channel.type
                if name not in schemas:
                    text = (channel.definition or definition(name)).encode()
                    schemas[name] = writer.register_schema(name, "ros2msg", text)
                metadata = {"offered_qos_profiles": channel.profiles}
                numbers[channel] = writer.register_channel(
                    channel.topic, "cdr", schemas[name], metadata
                )
            writer.add_message(numbers[channel], stamp, data, stamp)
        writer.finish()
