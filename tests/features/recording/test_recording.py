"""The last minutes in memory, and recordings of live topics."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest
from bench import Bench, benches

from webviz.commands import SaveMemory, StartRecording, StopRecording
from webviz.data.messages import MessageTypes, decode, encode
from webviz.data.recordings import RecordedChannel, open_recording
from webviz.data.recordings.folder_writing import RecordingFolder
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
from webviz.sources.recording import RecentMessages, recent, recorder
from webviz.sources.recording.channels import Channels
from webviz.sources.recording.memory import MEMORY_OFF
from webviz_displays.path import Path as PathDisplay
from webviz_displays.robot_model import RobotModel

STRING, PATH = "std_msgs/msg/String", "nav_msgs/msg/Path"
PAGE = Sender(1)


def raw(at_s: float, size: int = 10) -> Raw:
    return Raw(bytes(size), round(at_s * 1e9), at_s)


def contents(path: Path) -> list[tuple[str, int]]:
    """Return topics and stamps of a recording."""
    recording = open_recording(path)
    assert recording.span_ns is not None
    results = list(recording.messages(recording.channels, *recording.span_ns))
    recording.close()
    return [(message.channel.topic, message.stamp_ns) for message in results]


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


def test_a_memory_drops_messages_over_its_seconds_and_bytes() -> None:
    memory = RecentMessages(lambda topic: 0, seconds=10.0, max_bytes=3000)
    for second in range(20):
        memory.put("/a", raw(second))
    assert [m.received_ns // 10**9 for _, m in memory.last(1e9).messages] == list(range(10, 20))
    memory.put("/big", raw(20, size=2500))
    assert [(t, m.received_ns // 10**9) for t, m in memory.last(1e9).messages] == [
        ("/a", 19),
        ("/big", 20),
    ]


def test_large_messages_do_not_leave_a_past_without_small_ones() -> None:
    now_s = time.monotonic()
    memory = RecentMessages(lambda topic: 0, seconds=60.0, max_bytes=10 * recent.LARGE_BYTES)
    for second in range(50):
        memory.put("/tf", raw(now_s - 50 + second, size=1000))
        memory.put("/points", raw(now_s - 50 + second, size=recent.LARGE_BYTES))
    past = memory.last(1e9).messages
    assert [topic for topic, _ in past].count("/tf") == 50
    assert [topic for topic, _ in past].count("/points") == 9
    assert [m.arrived_s for _, m in past] == sorted(m.arrived_s for _, m in past)
    assert memory.size()[1] <= 10 * recent.LARGE_BYTES
    topics, seconds = memory.cut() or ((), 0.0)
    assert topics == ("/points",)
    assert 9.0 <= seconds < 15.0
    assert memory.after(now_s - 2.5)[0][0] == "/tf"


def test_small_messages_beyond_their_share_make_room_for_large_ones() -> None:
    now_s, size = time.monotonic(), 10 * recent.LARGE_BYTES
    memory = RecentMessages(lambda topic: 0, seconds=60.0, max_bytes=size)
    for number in range(40):
        memory.put("/scan", raw(now_s - 8 + number / 10, size=recent.LARGE_BYTES // 2))
    assert memory.size()[1] > 0.9 * size, "alone they have all"
    for number in range(40):
        memory.put("/points", raw(now_s - 4 + number / 10, size=recent.LARGE_BYTES))
    topics = [topic for topic, _ in memory.last(1e9).messages]
    assert topics.count("/scan") * recent.LARGE_BYTES / 2 > (recent.SMALL_SHARE - 0.1) * size
    assert topics.count("/points") >= 7
    assert memory.is_full


@pytest.mark.parametrize(("machine", "megabytes"), [(32_000_000_000, 512), (1_000_000_000, 125)])
def test_a_small_machine_remembers_less(
    machine: int, megabytes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(model, "memory_bytes", lambda: machine)
    assert MemorySettings().size_mb == megabytes
    assert MemorySettings(megabytes=2000.0).size_mb == 2000.0


def test_the_newest_latched_message_is_not_forgotten() -> None:
    memory = RecentMessages(lambda topic: int(topic == "/map"), seconds=10.0, max_bytes=10**6)
    memory.put("/map", raw(0))
    memory.put("/map", raw(1))
    memory.put("/scan", raw(2))
    memory.put("/scan", raw(100))
    past = memory.last(1e9)
    assert {topic: m.received_ns // 10**9 for topic, m in past.latched} == {"/map": 1}
    assert [topic for topic, _ in past.messages] == ["/scan"]


def test_latched_messages_are_forgotten_the_oldest_first_if_they_are_too_large_together(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(recent, "MAX_PINNED_BYTES", 2500)
    memory = RecentMessages(lambda topic: 1)
    for second, topic in enumerate(("/a", "/b", "/c", "/b")):
        memory.put(topic, raw(second, size=1000))
    assert memory.pinned() == ("/b", "/c")
    memory.put("/large", raw(9, size=9000))
    assert memory.pinned() == ("/large",)


def test_latched_messages_that_arrived_since_are_not_lost_with_the_memory_before_them() -> None:
    memory = RecentMessages(lambda topic: int(topic == "/map"), seconds=10.0, max_bytes=10**6)
    memory.put("/scan", raw(0))
    memory.put("/map", raw(1))
    memory.put("/scan", raw(100))
    assert [topic for topic, _ in memory.after(0.0)] == ["/map", "/scan"]
    assert [topic for topic, _ in memory.after(1.0)] == ["/scan"]


def test_latched_messages_that_just_fit_together_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recent, "MAX_PINNED_BYTES", 2000)
    memory = RecentMessages(lambda topic: 1)
    for second, topic in enumerate(("/a", "/b")):
        memory.put(topic, raw(second, size=1000))
    assert memory.pinned() == ("/a", "/b")
    memory.put("/c", raw(2, size=1000))
    assert memory.pinned() == ("/b", "/c")


def test_the_last_seconds_are_saved_with_latched_messages(bench: Bench) -> None:
    bench.publish("/robot_description", STRING, {"data": "<robot/>"})
    publish(bench)
    publish(bench)
    answer = bench.ask(SaveMemory(path="all"))
    assert answer == "Saved the last 2 s to all."
    assert [topic for topic, _ in contents(Path("all"))] == ["/robot_description", "/path", "/path"]


def test_earlier_latched_messages_are_saved_with_the_stamp_of_the_first(
    bench: Bench,
) -> None:
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


def test_static_transforms_of_all_publishers_are_kept() -> None:
    memory = RecentMessages(
        lambda topic: 2 * (topic == "/tf_static"), seconds=10.0, max_bytes=10**6
    )

    def static(child: str, x: float, at_s: float) -> None:
        transform = {"child_frame_id": child, "transform": {"translation": {"x": x}}}
        cdr = encode("tf2_msgs/msg/TFMessage", {"transforms": [transform]})
        memory.put("/tf_static", Raw(cdr, round(at_s * 1e9), at_s))

    for number, child in enumerate(("base", "laser", "base", "camera")):
        static(child, float(number), float(number))
    memory.put("/scan", raw(100))
    transforms = [
        decode("tf2_msgs/msg/TFMessage", r.cdr).transforms[0] for _, r in memory.last(1e9).latched
    ]
    assert [(t.child, t.translation[0]) for t in transforms] == [
        ("laser", 1.0),
        ("base", 2.0),
        ("camera", 3.0),
    ]


def test_a_topic_whose_publishers_disagree_on_the_type_has_no_channel() -> None:
    types = "nav_msgs/msg/Path", STRING
    one, two = (
        Offer(tuple(Publisher("/a", type_, "reliable", "volatile") for type_ in types[:count]))
        for count in (1, 2)
    )
    channels = Channels(lambda: {"/one": one, "/two": two})
    channel = channels.find("/one")
    assert channel is not None
    assert channel.type == "nav_msgs/msg/Path"
    assert channels.find("/two") is None


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


def test_a_memory_counts_messages_and_knows_its_size() -> None:
    now_s = time.monotonic()
    memory = RecentMessages(lambda topic: int(topic == "/map"), seconds=10.0, max_bytes=10**6)
    assert memory.is_on
    assert not RecentMessages(lambda topic: 0, seconds=0.0, max_bytes=10**6).is_on
    assert not RecentMessages(lambda topic: 0, seconds=10.0).is_on
    assert memory.size() == (0.0, 0)
    memory.put("/map", raw(now_s - 20.0, size=500))
    for age_s in (4.0, 2.0):
        memory.put("/a", raw(now_s - age_s, size=100))
    seconds, size = memory.size()
    assert 4.0 <= seconds < 8.0
    assert size == 500 + 2 * (100 + recent.OVERHEAD)
    part_s, counts = memory.counts()
    assert (part_s, counts.keys()) == (1.0, {"/a"})
    assert counts["/a"].total() == 2
    memory.seconds = 1000.0
    part_s, counts = memory.counts()
    assert part_s == 1000.0 / recent.MAX_PARTS
    assert counts["/a"].total() == 2


def test_a_topic_whose_publishers_ended_keeps_its_type() -> None:
    offers = {"/a": Offer((Publisher("/a", STRING, "best_effort", "volatile"),))}
    channels = Channels(lambda: offers)
    channels.look()
    offers = {"/a": Offer(())}  # subscribed to, by somebody else
    channels.look()
    channel = channels.find("/a")
    assert channel is not None
    assert channel.type == STRING
    assert "best_effort" in channel.profiles
    assert Channels(lambda: offers).find("/a") is None


def test_a_recording_ends_before_its_files_are_too_large(tmp_path: Path) -> None:
    offers = {"/a": Offer((Publisher("/a", STRING, "reliable", "volatile"),))}
    folder = RecordingFolder(tmp_path / "run", "test")
    writer = recorder.Recorder(folder, Channels(lambda: offers), max_bytes=10_000)
    for second in range(20):
        writer.put("/a", raw(second, size=1000))
    writer.close()
    assert writer.is_full
    assert 6 <= writer.messages <= 9, "what each takes besides its bytes counts, too"


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
