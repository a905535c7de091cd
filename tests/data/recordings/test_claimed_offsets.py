"""MCAP files whose summary names places that no file has, and many messages outside of chunks."""

from __future__ import annotations

import struct
import time
from pathlib import Path
from zlib import crc32

import pytest
from mcap_files import MAGIC, Chunk, mcap, message, plain, record, text

from webviz.data.recordings import open_recording
from webviz.data.recordings.recording import TimeParts

BEYOND = (1 << 40, 2**62, 2**63 - 1, 2**63, 2**64 - 1)
OFFSET, CHANNEL_OFFSET, INDEX_SIZE, PACKED_SIZE, SIZE = 16, 38, 46, -16, -8
"""Fields of the record of the summary that describes a chunk without compression."""
MESSAGES, CHANNELS = 100_000, 100
SECONDS = 1.5


def claiming(field: int, value: int) -> bytes:
    """A file whose summary is intact but for one field about the first of two chunks."""
    data = bytearray(mcap([plain(1, 2, 3), plain(4, 5)]))
    footer = len(data) - len(MAGIC) - 29
    (start,) = struct.unpack_from("<Q", data, footer + 9)
    at = start
    while data[at] != 8:
        at += 9 + struct.unpack_from("<Q", data, at + 1)[0]
    (length,) = struct.unpack_from("<Q", data, at + 1)
    struct.pack_into("<Q", data, at + 9 + (field if field >= 0 else length + field), value)
    struct.pack_into("<I", data, footer + 25, crc32(data[start : footer + 25]))
    return bytes(data)


@pytest.mark.parametrize("field", [OFFSET, CHANNEL_OFFSET, INDEX_SIZE, PACKED_SIZE, SIZE])
@pytest.mark.parametrize("value", BEYOND)
def test_claims_beyond_the_file_lose_no_other_chunk(tmp_path: Path, field: int, value: int) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(claiming(field, value))
    recording = open_recording(path)
    (channel,) = recording.channels
    stamps = [each.stamp_ns for each in recording.messages([channel], 0, 2**63)]
    assert recording.histogram(TimeParts(1, 5, 5)).keys() == {channel}
    recording.close()
    assert stamps[-2:] == [4, 5]
    # Where a chunk is said to be elsewhere, the file is scanned.
    assert field != OFFSET or stamps == [1, 2, 3, 4, 5]


def test_an_honest_chunk_is_found_by_its_summary(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(mcap([plain(1), Chunk(b"", 0), plain(2)]))
    recording = open_recording(path)
    assert [each.stamp_ns for each in recording.messages(recording.channels, 0, 9)] == [1, 2]
    recording.close()


def test_messages_of_many_channels_outside_of_chunks_are_found_in_seconds(tmp_path: Path) -> None:
    content = bytearray(MAGIC + record(1, text("ros2") + text("")))
    for number in range(1, CHANNELS + 1):
        schema = text("std_msgs/msg/Empty") + text("ros2msg") + text("")
        content += record(3, struct.pack("<H", number) + schema)
        channel = text(f"/t{number}") + text("cdr") + text("")
        content += record(4, struct.pack("<HH", number, number) + channel)
    for index in range(MESSAGES):
        fields = struct.pack("<HIQQ", index % CHANNELS + 1, index, index, index)
        content += record(5, fields + bytes(4))
    path = tmp_path / "a.mcap"
    path.write_bytes(bytes(content) + record(15, bytes(4)) + record(2, bytes(20)) + MAGIC)
    start_s = time.process_time()
    recording = open_recording(path)
    taken_s = time.process_time() - start_s
    counts = recording.histogram(TimeParts(0, MESSAGES - 1, 10))
    recording.close()
    assert {int(each.sum()) for each in counts.values()} == {MESSAGES // CHANNELS}
    assert taken_s < SECONDS


def test_messages_of_one_time_stay_in_the_order_of_the_file(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    parts = [message(3, "a"), Chunk(message(3, "b"), len(message(3, "b")), span_ns=(3, 3))]
    path.write_bytes(mcap([*parts, message(3, "c")], with_summary=False))
    recording = open_recording(path)
    results = [each.data[-2:-1] for each in recording.messages(recording.channels, 0, 9)]
    assert results == [b"a", b"b", b"c"]
    recording.close()


def test_regions_end_where_something_else_lies_between(tmp_path: Path) -> None:
    parts = [message(1, "a"), message(2, "b"), plain(3), message(5, "c"), plain(6), message(4, "d")]
    path = tmp_path / "a.mcap"
    path.write_bytes(mcap(parts, with_summary=False))
    recording = open_recording(path)
    results = [each.stamp_ns for each in recording.messages(recording.channels, 0, 9)]
    assert results == [1, 2, 3, 4, 5, 6]
    recording.close()
