"""MCAP files without a summary, whose chunks are found by the index behind each."""

from __future__ import annotations

from pathlib import Path

import pytest

from webviz.data.recordings import RecordedChannel, mcap_index, open_recording
from webviz.data.recordings.mcap_writing import McapFile

CHUNKS = 6
TOPICS = ("/one", "/two", "/late")


def write_bag(path: Path) -> Path:
    """A file whose recorder was killed; the third topic begins late."""
    file = McapFile(path, "webviz test")
    for number in range(CHUNKS):
        for place, topic in enumerate(TOPICS if number >= 3 else TOPICS[:2]):
            channel = RecordedChannel(topic, "std_msgs/msg/String", "cdr", "string data", "")
            for repeat in range(2):
                file.add(channel, 100 * number + 10 * repeat + place, f"{topic} {number}".encode())
        file.flush()
    file.close(is_whole=False)
    return path


def contents(path: Path) -> list[list[tuple[int, bytes]]]:
    """The messages of each topic, read by itself."""
    recording = open_recording(path)
    results = [
        [(message.stamp_ns, message.data) for message in recording.messages([channel], 0, 10**9)]
        for channel in sorted(recording.channels, key=lambda channel: channel.topic)
    ]
    recording.close()
    return results


def test_only_chunks_that_may_have_new_channels_are_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    unpacked: list[int] = []
    contents_of = mcap_index.contents_of

    def noted(chunk: mcap_index.McapChunk, file: mcap_index.BinaryIO) -> tuple[bytes, str]:
        unpacked.append(chunk.start_ns)
        return contents_of(chunk, file)

    monkeypatch.setattr(mcap_index, "contents_of", noted)
    recording = open_recording(write_bag(tmp_path / "run.mcap"))
    recording.close()
    assert unpacked == [0, 300, 500]  # behind the last one, more may be missing


def test_a_damaged_index_hides_no_message(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "run.mcap")
    truth = contents(path)
    assert [len(each) for each in truth] == [6, 12, 12]
    whole = path.read_bytes()
    with path.open("rb") as file:
        index = mcap_index.McapIndex(file, path, mcap_index.Losses("chunk", "skipped"))
    for chunk in index.chunks[1], index.chunks[4]:
        start, size = chunk.index
        for place in range(start, start + size):
            for bit in (0, 3):
                damaged = bytearray(whole)
                damaged[place] ^= 1 << bit
                path.write_bytes(damaged)
                assert contents(path) == truth, (place - start, bit)
