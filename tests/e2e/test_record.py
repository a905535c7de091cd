"""`webviz record` as a user starts it, on a real ROS graph."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from mcap.exceptions import EndOfFile
from mcap.records import Message
from mcap.stream_reader import StreamReader
from program import Program
from rosbags.rosbag2 import Reader

from webviz.data.recordings import open_recording

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")


@pytest.fixture(scope="module", autouse=True)
def simulator(start: Callable[..., Program]) -> Program:
    """A simulated robot."""
    return start("webviz_sim")


def topics_of(path: Path) -> set[str]:
    """Return the topics with messages in what is on the disk."""
    try:
        recording = open_recording(path)
    except Exception:  # nothing is written yet
        return set()
    with_messages = {channel.topic for channel in recording.channels}
    recording.close()
    return with_messages


def wait_for_topics(program: Program, path: Path, topics: set[str]) -> None:
    for _ in range(3000):
        if topics <= topics_of(path):
            return
        program.process.poll()
        assert program.process.returncode is None, program.output()
        signal.sigtimedwait([], 0.05)
    raise AssertionError(f"{topics_of(path)}: {program.output()}")


def test_all_topics_are_recorded_with_latched_messages(
    start: Callable[..., Program], tmp_path: Path
) -> None:
    path = tmp_path / "run"
    program = start("webviz", "record", "-o", str(path))
    expected = {"/map", "/robot_description", "/tf", "/tf_static", "/odom", "/scan"}
    wait_for_topics(program, path, expected)
    assert program.end() == 0
    match = program.wait_for(r"recorded (\d+) messages of (\d+) topics in \d+ s, [\d.]+ MB\.")
    with Reader(path) as bag:
        assert bag.message_count == int(match[1])
        assert len(bag.connections) == int(match[2])
        assert sum(1 for _ in bag.messages()) == bag.message_count
        assert expected <= set(bag.topics)
        assert not any("/_" in topic for topic in bag.topics)


def test_a_killed_recording_keeps_flushed_messages_and_is_recovered(
    start: Callable[..., Program], tmp_path: Path
) -> None:
    path = tmp_path / "run"
    program = start("webviz", "record", "-o", str(path), "--topics", "/tf*", "/scan")
    wait_for_topics(program, path, {"/tf", "/tf_static", "/scan"})
    program.end(signal.SIGKILL)
    recording = open_recording(path)
    assert recording.span_ns is not None
    read = list(recording.messages(recording.channels, *recording.span_ns))
    recording.close()
    assert {message.channel.topic for message in read} == {"/tf", "/tf_static", "/scan"}
    (file,) = path.glob("*.mcap")
    streamed = 0
    with file.open("rb") as stream:
        records = StreamReader(stream).records
        with contextlib.suppress(EndOfFile):
            while record := next(records):
                streamed += isinstance(record, Message)
    assert streamed == len(read), "only the end is missing"
    program = start("webviz", "recover", str(path))
    assert program.process.wait(timeout=60) == 0, program.output()
    whole = tmp_path / "run_recovered"
    assert program.output() == (
        f"webviz: wrote {len(read)} messages to {whole}. The original has no end.\n"
    )
    with Reader(whole) as bag:
        assert sum(1 for _ in bag.messages()) == bag.message_count == len(read)
    program = start("webviz", "recover", str(path))
    assert program.process.wait(timeout=60) == 1
    assert "run_recovered is not empty" in program.output()


def test_a_folder_that_cannot_be_written_is_one_sentence(start: Callable[..., Program]) -> None:
    program = start("webviz", "record", "-o", "/proc/run")
    assert program.process.wait(timeout=60) == 1
    assert program.output() == (
        "webviz: /proc/run cannot be written: No such file or directory. "
        "Choose another folder or disk.\n"
    )
