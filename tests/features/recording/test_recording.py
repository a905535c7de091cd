"""The last minutes in memory, and recordings of live topics."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest
from bench import Bench, benches

from tests.sources.recording.messages import contents
from webviz.commands import SaveMemory, StartRecording, StopRecording
from webviz.data.messages import decode, encode
from webviz.data.recordings import open_recording
from webviz.engine.commands import Sender
from webviz.engine.parts.settings import SettingsPart
from webviz.features.recording import (
    MemoryState,
    RecordingState,
    RecordingStore,
    RunningRecording,
    recording_store,
)
from webviz.files.config import Settings, model
from webviz.files.config.model import MemorySettings
from webviz.sources import Offer, Publisher, Raw
from webviz.sources.recording.memory import MEMORY_OFF
from webviz_displays.path import Path as PathDisplay
from webviz_displays.robot_model import RobotModel

STRING, PATH = "std_msgs/msg/String", "nav_msgs/msg/Path"
PAGE = Sender(1)


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    """A viewer of a path and of a robot, whose description is latched."""
    monkeypatch.chdir(tmp_path)
    with benches() as make:
        bench = make(PathDisplay(), RobotModel())
        latched = Publisher("/robot_state_publisher", STRING, "reliable", "transient_local")
        bench.source.topics["/robot_description"] = Offer((latched,))
        yield bench


def publish(bench: Bench) -> None:
    bench.source.now += 1_000_000_000
    bench.publish("/path", PATH, {"header": {"frame_id": "map"}})


@pytest.mark.parametrize(("machine", "megabytes"), [(32_000_000_000, 512), (1_000_000_000, 125)])
def test_a_small_machine_remembers_less(
    machine: int, megabytes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(model, "memory_bytes", lambda: machine)
    assert MemorySettings().size_mb == megabytes
    assert MemorySettings(megabytes=2000.0).size_mb == 2000.0


def test_the_last_seconds_are_saved_with_latched_messages(bench: Bench) -> None:
    bench.publish("/robot_description", STRING, {"data": "<robot/>"})
    publish(bench)
    publish(bench)
    answer = bench.ask(SaveMemory(path="all"))
    assert answer == "Saved the last 2 s to all."
    assert [topic for topic, _ in contents(Path("all"))] == ["/robot_description", "/path", "/path"]


def test_earlier_latched_messages_are_saved_with_the_stamp_of_the_first(bench: Bench) -> None:
    described = Raw(encode(STRING, {"data": "<robot/>"}), 50 * 10**9, time.monotonic() - 20.0)
    bench.source.inbox.put("/robot_description", described)
    publish(bench)
    bench.ask(SaveMemory(10.0, "last"))
    (description, first_ns), (path, path_ns) = contents(Path("last"))
    assert (description, path) == ("/robot_description", "/path")
    assert first_ns == path_ns


def test_a_recording_begins_with_latched_messages_and_ends_on_request(bench: Bench) -> None:
    bench.publish("/robot_description", STRING, {"data": "<robot/>"})
    publish(bench)
    assert bench.ask(StartRecording()).startswith("Recording to webviz_")
    publish(bench)
    publish(bench)
    state = bench.do(StartRecording("other")).recording
    assert state is not None, "the second is refused"
    assert bench.ask(StopRecording()) == f"Recorded 3 messages to {state.path.name}."
    stamps = [stamp_ns // 10**9 for _, stamp_ns in contents(state.path)]
    assert [topic for topic, _ in contents(state.path)] == ["/robot_description", "/path", "/path"]
    assert stamps[-2:] == [102, 103]
    assert not Path("other").exists()
    assert bench.refusal(StopRecording()) == "Nothing is being recorded."


def test_messages_keep_their_bytes_and_type(bench: Bench) -> None:
    cdr = encode(PATH, {"header": {"frame_id": "map"}})
    bench.source.put("/path", PATH, cdr)
    bench.do(SaveMemory(path="run"))
    recording = open_recording(Path("run"))
    (channel,) = recording.channels
    (message,) = recording.messages([channel], 0, 2**62)
    recording.close()
    assert (channel.type, message.data) == (PATH, cdr)
    assert decode(PATH, message.data).header.frame_id == "map"


def test_a_full_disk_ends_a_recording_with_a_status(bench: Bench) -> None:
    bench.do(StartRecording("run"))
    for file in Path("run").iterdir():
        file.unlink()
    Path("run").rmdir()
    publish(bench)
    bench.ask(SaveMemory(path="other"))
    while not (status := bench.do(SaveMemory(path="x")).statuses.get("Recording")):
        pass
    assert status.text.startswith(f"{Path('run').absolute()} cannot be written: No such file")
    assert status.text.endswith("The recording has ended.")
    bench.do(StartRecording("again"))
    assert bench.ask(StopRecording()) == "Recorded 0 messages to again."


def test_settings_bound_the_memory(bench: Bench) -> None:
    publish(bench)
    bench.viewer.get(SettingsPart).settings = Settings(memory=MemorySettings(seconds=0.0))
    bench.do(StopRecording())
    publish(bench)
    assert "raise memory.seconds in the config" in bench.refusal(SaveMemory())


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (SaveMemory(), "No messages are kept in memory."),
        (SaveMemory(-1.0), "-1 s is not a valid time span."),
        (SaveMemory(0.0), "0 s is not a valid time span."),
        (SaveMemory(float("nan")), "nan s is not a valid time span."),
        (StartRecording("."), "is not empty. Give the name of a new folder."),
    ],
)
def test_invalid_recordings_are_refused_with_the_reason(
    bench: Bench, command: SaveMemory | StartRecording, reason: str
) -> None:
    Path("file").touch()
    assert reason in bench.refusal(command)


def test_a_page_cannot_choose_the_folder(bench: Bench) -> None:
    answer = bench.viewer.enqueue(StartRecording("/etc/run"), PAGE)
    bench.until_done(answer)
    assert str(answer.exception()) == "A page cannot choose the folder of a recording."


def test_times_of_a_recording_go_on_when_the_clock_jumps_back(bench: Bench) -> None:
    bench.ask(StartRecording("run"))
    publish(bench)
    bench.source.now -= 50_000_000_000
    publish(bench)
    publish(bench)
    bench.ask(StopRecording())
    stamps = [stamp_ns for topic, stamp_ns in contents(Path("run")) if topic == "/path"]
    assert stamps == sorted(stamps)
    assert stamps[0] == 101_000_000_000
    assert stamps[2] - stamps[1] == 1_000_000_000, "as far apart as they were"
    assert 0 < stamps[1] - stamps[0] < 50_000_000_000


LIMITS = MemorySettings(seconds=60.0, megabytes=512.0)
REMEMBERS = "Remembers the last 60 s of the displayed topics, up to 512 MB."


def test_the_store_of_recordings_has_memory_and_recording() -> None:
    memory = MemoryState(61.7, 2_999_999)
    running = RecordingState(
        path=Path("folder/run"), seconds=3.9, messages=5, size=1_260_000, dropped=2
    )
    page_recording = RunningRecording(name="run", seconds=3, megabytes=1.3, dropped=2)
    assert recording_store(memory, running, LIMITS) == RecordingStore(
        (61, 2), True, REMEMBERS, page_recording
    )
    assert recording_store(memory, None, LIMITS) == RecordingStore((61, 2), True, REMEMBERS, None)
    assert recording_store(None, running, LIMITS) is None
    store = recording_store(msgspec.structs.replace(memory, held_s=95.3), None, LIMITS)
    assert store is not None
    assert store.past_s == 95


@pytest.mark.parametrize("off", [{"seconds": 0.0}, {"megabytes": 0.0}])
def test_the_store_of_recordings_reports_missing_memory(off: dict[str, float]) -> None:
    limits = msgspec.structs.replace(LIMITS, **off)
    off_store = RecordingStore((0, 0), False, MEMORY_OFF, None)
    assert recording_store(MemoryState(0.0, 0), None, limits) == off_store


@pytest.mark.parametrize(
    ("is_full", "pinned", "sentences"),
    [
        (True, (), "Older messages are dropped already: raise memory.megabytes."),
        (
            False,
            tuple("abcd"),
            "Older latched messages and last transforms are kept of a, b, c, d.",
        ),
        (
            False,
            tuple("abcde"),
            "Older latched messages and last transforms are kept of a, b, c, d ….",
        ),
    ],
)
def test_the_store_of_recordings_names_the_bound_reached(
    is_full: bool, pinned: tuple[str, ...], sentences: str
) -> None:
    result = recording_store(MemoryState(1.0, 1, is_full, pinned), None, LIMITS)
    assert result is not None
    assert result.about == f"{REMEMBERS} {sentences}"
