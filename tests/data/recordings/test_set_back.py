"""Bags whose recorder's clock was set back."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from bags import START_NS, files, ns, strings
from rosbags.rosbag2 import StoragePlugin

from webviz.data.recordings import RecordedChannel, open_recording
from webviz.data.recordings.mcap_writing import McapFile
from webviz.data.recordings.recording import TimeParts
from webviz.data.recordings.sqlite import SqliteRecording

TWICE = [*range(100), *range(50, 150)]
"""Times of recording in s: after 100 s, the clock was set back by 50 s."""
SENTENCE = (
    "The clock was set back by 49 s while {} was recorded: from 50.0 to 99.0 s, messages from "
    "before and after are interleaved. Select a span outside this range."
)


def test_a_jump_of_the_clock_is_reported_of_mcap(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    file = McapFile(path, "webviz test")
    channel = RecordedChannel("/words", "std_msgs/msg/String", "cdr", "string data", "")
    for number, at_s in enumerate(TWICE):
        file.add(channel, START_NS + ns(at_s), b"")
        if number % 7 == 6:
            file.flush()
    file.close()
    recording = open_recording(path)
    recording.close()
    assert recording.losses.notes == [SENTENCE.format("run.mcap")]


def test_a_jump_of_the_clock_is_reported_of_db3_once_it_is_read(tmp_path: Path) -> None:
    bag = strings(*range(200))
    (path,) = files(bag.write(tmp_path / "run", StoragePlugin.SQLITE3), ".db3")
    set_times(path)
    recording = SqliteRecording(path)
    for _ in range(2):
        recording.histogram(TimeParts(START_NS, START_NS + ns(150), 10))
    recording.close()
    assert recording.losses.notes == [SENTENCE.format(path.name)]


def set_times(path: Path) -> None:
    """Let messages have the times of `TWICE` in the order of writing."""
    db = sqlite3.connect(path)
    for number, at_s in enumerate(TWICE, 1):
        db.execute("UPDATE messages SET timestamp = ? WHERE id = ?", (START_NS + ns(at_s), number))
    db.commit()
    db.close()


def test_topics_written_one_after_the_other_are_not_a_jump_of_time(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    file = McapFile(path, "webviz test")
    for topic in ("/one", "/two"):
        channel = RecordedChannel(topic, "std_msgs/msg/String", "cdr", "string data", "")
        for at_s in range(100):
            file.add(channel, START_NS + ns(at_s), b"")
            if at_s % 30 == 7:
                file.flush()
    file.close()
    recording = open_recording(path)
    recording.close()
    assert recording.losses.notes == []
