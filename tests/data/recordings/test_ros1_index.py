"""ROS 1 bags whose index is missing, damaged or cut off, as that of a recorder that was killed."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

import pytest
from ros1_bags import written
from rosbags.rosbag1 import Reader, Writer

from webviz.data.recordings import RecordingError, open_recording
from webviz.data.recordings.recording import END_MISSING
from webviz.shell.cli.recover import recover

CHUNK, CONNECTION, INDEX = b"\x05", b"\x07", b"\x04"
SECONDS, CHUNK_BYTES = 3, 700
COMPRESSIONS = [None, *Writer.CompressionFormat]
Content = list[tuple[str, int, bytes]]


def records(data: bytes) -> Iterator[tuple[int, int, bytes]]:
    """Kinds of the records of a bag, with the offsets at which they begin and end."""
    at = data.index(b"\n") + 1
    while at < len(data):
        (size,) = struct.unpack_from("<I", data, at)
        header = data[at + 4 : at + 4 + size]
        (length,) = struct.unpack_from("<I", data, at + 4 + size)
        end = at + 8 + size + length
        yield at, end, header[header.index(b"op=") + 3 :][:1]
        at = end


def with_index_at(data: bytes, place: int) -> bytes:
    """A bag whose header says that its index is elsewhere, zero if there is none."""
    at = data.index(b"index_pos=") + len(b"index_pos=")
    return data[:at] + struct.pack("<Q", place) + data[at + 8 :]


def unindexed(data: bytes) -> bytes:
    """A bag as `rosbag record` leaves it when it is killed: nothing comes behind the chunks."""
    end = next(at for at, _, kind in records(data) if kind == CONNECTION)
    return with_index_at(data, 0)[:end]


def read(path: Path) -> tuple[Content, str]:
    """All messages of a bag, and what is lost."""
    recording = open_recording(path)
    try:
        result = recording.messages(recording.channels, 0, 2**63)
        content = [(each.channel.topic, each.stamp_ns, each.data) for each in result]
        return sorted(content), str(recording.losses)
    finally:
        recording.close()


@pytest.fixture(params=COMPRESSIONS, ids=str)
def bag(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[Path, Content]:
    path = written(tmp_path / "run.bag", request.param, SECONDS, CHUNK_BYTES)
    content, warning = read(path)
    with Reader(path) as reader:
        expected = sorted((each.topic, stamp_ns) for each, stamp_ns, _ in reader.messages())
    assert [each[:2] for each in content] == expected
    assert len(content) == 3 + 20 * SECONDS
    assert not warning
    return path, content


def test_a_bag_of_a_recorder_that_was_killed_is_read(bag: tuple[Path, Content]) -> None:
    path, content = bag
    path.write_bytes(unindexed(path.read_bytes()))
    assert read(path) == (content, END_MISSING)


def test_a_bag_whose_index_leads_elsewhere_is_read(bag: tuple[Path, Content]) -> None:
    path, content = bag
    for place in (1, 20, 2**40, 2**63):
        path.write_bytes(with_index_at(path.read_bytes(), place))
        assert read(path) == (content, "" if place < 2**40 else END_MISSING)


def test_chunks_that_lack_their_index_are_looked_into(bag: tuple[Path, Content]) -> None:
    path, content = bag
    data = path.read_bytes()
    parts = [data[at:end] for at, end, kind in records(data) if kind != INDEX]
    path.write_bytes(data[: data.index(b"\n") + 1] + b"".join(parts))
    assert read(path) == (content, "")


def test_complete_records_of_a_truncated_bag_are_read(tmp_path: Path) -> None:
    path = written(tmp_path / "run.bag", None, 1, CHUNK_BYTES)
    data, (content, _) = path.read_bytes(), read(path)
    places = list(records(data))
    last = 0
    for at in range(places[0][1], len(data), 37):
        path.write_bytes(data[:at])
        messages, warning = read(path)
        assert set(messages) <= set(content)
        assert len(messages) >= last
        assert END_MISSING in warning or at in {end for _, end, _ in places}
        last = len(messages)
    assert last == len(content)


def test_a_record_that_is_damaged_loses_no_other_chunk(bag: tuple[Path, Content]) -> None:
    path, content = bag
    data = path.read_bytes()
    chunks = [at for at, _, kind in records(data) if kind == CHUNK]
    middle = chunks[len(chunks) // 2]
    path.write_bytes(data[:middle] + b"\xff" * 6 + data[middle + 6 :])
    messages, warning = read(path)
    assert set(messages) < set(content)
    assert len(content) - len(messages) == 6
    assert "a record is damaged" in warning


def test_recover_writes_the_complete_records_of_a_bag(
    bag: tuple[Path, Content], capsys: pytest.CaptureFixture[str]
) -> None:
    path, content = bag
    path.write_bytes(unindexed(path.read_bytes()))
    whole = path.with_name("whole")
    assert recover(path, output=whole) == 0
    assert f"wrote {len(content)} messages to {whole}. The original has no end." in (
        capsys.readouterr().err
    )
    messages, warning = read(whole)
    assert ([each[:2] for each in messages], warning) == ([each[:2] for each in content], "")


def test_a_bag_of_an_old_format_or_an_encrypted_one_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path / "run.bag", seconds=1)
    data = path.read_bytes()
    path.write_bytes(data.replace(b"V2.0", b"V1.2", 1))
    with pytest.raises(RecordingError, match=r"has format '1\.2': run `rosbag reindex"):
        open_recording(path)
    secret = struct.pack("<I", 16) + b"encryptor=secret"
    size, start = struct.unpack_from("<I", data, 13)[0], 17
    header = data[start : start + size] + secret
    (length,) = struct.unpack_from("<I", data, start + size)
    rest = data[start + size + 4 + len(secret) :]
    assert length > len(secret)
    path.write_bytes(
        data[:13]
        + struct.pack("<I", len(header))
        + header
        + struct.pack("<I", length - len(secret))
        + rest
    )
    with pytest.raises(RecordingError, match="is encrypted"):
        open_recording(path)
