"""Messages of chunks that are remembered."""

from __future__ import annotations

from pathlib import Path

import pytest
from bags import START_NS, files, ns, strings

from webviz.data.messages import decode
from webviz.data.recordings import mcap
from webviz.data.recordings.mcap import McapRecording
from webviz.data.recordings.mcap_chunks import McapChunk


def test_small_messages_of_a_chunk_are_unpacked_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bag = strings(0, 1, 2)
    bag.add("/large", "std_msgs/msg/String")
    bag.add("/mixed", "std_msgs/msg/String")
    for at_s in (0.5, 1.5):
        bag.put(at_s, "/large", {"data": f"{at_s}" + 20_000 * "a"})
        bag.put(at_s, "/mixed", {"data": f"{at_s}" + round(20_000 * (at_s - 0.5)) * "b"})
    (file,) = files(bag.write(tmp_path / "run"), ".mcap")
    recording = McapRecording(file)
    unpacked: list[McapChunk] = []
    unpack = mcap.contents_of
    monkeypatch.setattr(
        mcap, "contents_of", lambda chunk, file: unpacked.append(chunk) or unpack(chunk, file)
    )

    def read(*topics: str) -> list[str]:
        channels = [channel for channel in recording.channels if channel.topic in topics]
        result = recording.messages(channels, START_NS, START_NS + ns(2))
        return [decode("std_msgs/msg/String", each.data).data[:3] for each in result]

    assert read("/words") == ["0", "1", "2"]
    assert read("/words") == ["0", "1", "2"]
    assert len(unpacked) == 1
    assert read("/large") == ["0.5", "1.5"]
    assert read("/words", "/mixed") == ["0", "0.5", "1", "1.5", "2"]
    assert len(unpacked) == 3
    assert read("/words") == ["0", "1", "2"]
    assert len(unpacked) == 3
    recording.close()
