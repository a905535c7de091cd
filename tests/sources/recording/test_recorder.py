"""Recordings, which a thread writes."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest

from tests.sources.recording.messages import contents, raw
from webviz.data.messages import MessageTypes
from webviz.data.recordings import RecordedChannel
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.sources import Offer, Publisher
from webviz.sources.recording import recorder
from webviz.sources.recording.channels import Channels

STRING = "std_msgs/msg/String"


def test_messages_wait_for_the_type_of_their_topic(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    requests: list[str] = []
    offers = {"/known": Offer((Publisher("/a", STRING, "reliable", "volatile"),))}

    class Late(Channels):
        """Knows a topic when it is asked for the third time."""

        def find(self, topic: str, types: MessageTypes | None = None) -> RecordedChannel | None:
            requests.append(topic)
            return super().find("/known") if len(requests) > 2 and topic != "/never" else None

    monkeypatch.setattr(recorder, "UNKNOWN_S", 0.3)
    folder = RecordingFolder(tmp_path / "run", "test")
    writer = recorder.Recorder(folder, Late(lambda: offers))
    writer.put("/late", replace(raw(0), arrived_s=time.monotonic()))
    writer.put("/never", replace(raw(1), arrived_s=time.monotonic()))
    writer.close()
    assert (writer.messages, writer.dropped) == (1, 1)
    assert len(requests) > 4


def test_messages_waiting_for_the_disk_are_bounded_and_drops_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recorder, "MAX_BYTES", 3000)
    disk, is_begun = threading.Lock(), threading.Event()

    class Slow(Channels):
        """Answers once the disk does."""

        def find(self, topic: str, types: MessageTypes | None = None) -> RecordedChannel | None:
            is_begun.set()
            with disk:
                return super().find(topic, types)

    offers = {"/a": Offer((Publisher("/a", STRING, "reliable", "volatile"),))}
    with disk:
        folder = RecordingFolder(tmp_path / "run", "test")
        writer = recorder.Recorder(folder, Slow(lambda: offers), past=[("/a", raw(0))])
        assert is_begun.wait(60.0)
        for second in range(1, 6):
            writer.put("/a", raw(second, size=1000))
        assert writer.dropped == 2
        writer.put("/a", raw(6, size=5000))  # larger than all that may wait
        assert writer.dropped == 5
    writer.close()
    assert [stamp_ns // 10**9 for _, stamp_ns in contents(tmp_path / "run")] == [0, 6]


def test_a_recording_ends_before_its_files_are_too_large(tmp_path: Path) -> None:
    offers = {"/a": Offer((Publisher("/a", STRING, "reliable", "volatile"),))}
    folder = RecordingFolder(tmp_path / "run", "test")
    before_s = time.monotonic()
    writer = recorder.Recorder(folder, Channels(lambda: offers), max_bytes=10_000)
    assert 0.0 <= writer.seconds <= time.monotonic() - before_s
    for second in range(20):
        writer.put("/a", raw(second, size=1000))
    writer.close()
    assert writer.is_full
    assert 0 < writer.bytes_written <= 10_000
    assert 6 <= writer.messages <= 9, "what each takes besides its bytes counts, too"
