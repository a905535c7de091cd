"""Bags of ROS 1: the same messages, as ROS 2 has them."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from itertools import takewhile
from pathlib import Path
from typing import Any

import pytest
from ros1_bags import SECOND, STORE, T, head, written
from rosbags.rosbag1 import Writer

from webviz.commands import Seek
from webviz.data.messages import decode
from webviz.data.messages.ros1 import Ros1Type
from webviz.data.recordings import RecordingError, open_recording
from webviz.data.recordings.ros1 import Ros1Recording
from webviz.shell.testing import BagViewer, check_seeks
from webviz.sources.bag.history import BagHistory
from webviz.sources.bag.log import read_log
from webviz.sources.player import Player


@pytest.mark.parametrize("compression", [None, *Writer.CompressionFormat])
def test_its_messages_are_those_of_ros_2(
    tmp_path: Path, open_bag: Callable[..., Any], compression: Writer.CompressionFormat | None
) -> None:
    bag = open_bag(written(tmp_path / "run.bag", compression))
    expected = {
        "/scan": "sensor_msgs/msg/LaserScan",
        "/camera_info": "sensor_msgs/msg/CameraInfo",
        "/harvest": "fruit_of_ros_1/msg/Harvest",
    }
    result: dict[str, list[Any]] = {}
    for topic, name in expected.items():
        bag.want(topic, type_name=name)
        bag.source.jump(bag.source.history.end_ns)
        bag.play(10)
        arrived = bag.source.inbox.drain().get(topic, ())
        result[topic] = [decode(name, raw.cdr, raw.types) for raw in arrived]
    assert bag.source.warnings == []
    newest = result["/scan"][-1]
    assert (newest.header.frame_id, newest.header.stamp_ns) == ("laser", 1009_900_000_000)
    assert newest.ranges.tolist() == pytest.approx([1, 2, 12.9])
    assert result["/camera_info"][0].k.tolist() == list(range(9))
    (pears, _) = result["/harvest"][0].baskets
    assert (pears.name, list(pears.size), pears.is_full) == ("pears", [3, -4], True)
    assert result["/harvest"][0].ripe.sec == -2


def test_seeking_equals_playing(tmp_path: Path) -> None:
    check_seeks(written(tmp_path / "run.bag"), count=5)


def test_latched_topics_are_transient_local(tmp_path: Path) -> None:
    source = Player(BagHistory(written(tmp_path / "run.bag")))
    (publisher,) = source.offers()["/tf_static"].publishers
    assert publisher.durability == "transient_local"
    source.close()


def test_warnings_of_rosout_are_events(tmp_path: Path) -> None:
    path, name = tmp_path / "run.bag", "rosgraph_msgs/msg/Log"
    with Writer(path) as writer:
        connection = writer.add_connection("/rosout", name, typestore=STORE)
        for number, level in enumerate((1, 2, 4, 8, 16)):
            log = T[name](head("", number), level, "driver", f"level {level}", "a.cpp", "f", 1, [])
            raw = STORE.serialize_ros1(log, name)
            writer.write(connection, (1000 + number) * SECOND, raw)
    events = read_log([path]).events
    assert [(event.at_ns // SECOND, event.level.name, event.text) for event in events] == [
        (1002, "WARN", "level 4"),
        (1003, "ERROR", "level 8"),
        (1004, "ERROR", "level 16"),
    ]


def test_one_flipped_bit_ends_in_a_sentence(tmp_path: Path) -> None:
    path = written(tmp_path / "run.bag", seconds=2)
    good, line_breaks = path.read_bytes(), set[int]()
    for place in range(0, len(good), 61):
        data = bytearray(good)
        data[place] ^= 1 << place % 8
        path.write_bytes(data)
        try:
            recording = open_recording(path)
        except RecordingError as error:
            line_breaks.add(str(error).count("\n"))
            continue
        if recording.span_ns:
            list(recording.messages(recording.channels, *recording.span_ns))
        recording.close()
    assert line_breaks <= {0}


def counted(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The sizes of messages that are converted from now on."""
    converted: list[int] = []
    convert = Ros1Type.to_cdr

    def counting(own: Ros1Type, data: bytes) -> bytes:
        converted.append(len(data))
        return convert(own, data)

    monkeypatch.setattr(Ros1Type, "to_cdr", counting)
    return converted


def test_messages_are_converted_once_for_several_seeks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with contextlib.closing(BagViewer(written(tmp_path / "run.bag"))) as viewer:
        viewer.do(Seek(9.0))
        converted = counted(monkeypatch)
        viewer.do(Seek(2.0))
        viewer.do(Seek(9.0))
    assert not converted


def test_converted_messages_that_are_kept_are_bounded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.data.recordings.ros1.MAX_CONVERTED", 1000)
    recording = Ros1Recording(written(tmp_path / "run.bag"))
    results = list(recording.messages(recording.channels, 0, 2**63))
    assert len(results) > 100
    converted = counted(monkeypatch)
    # The newest are kept; to convert one that is not would lose another.
    remaining = takewhile(lambda _: not converted, recording.newest(recording.channels, 2**63))
    assert 0 < sum(len(each.data) for each in remaining) <= 1000
    recording.close()
