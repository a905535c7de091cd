"""MCAP files of programs with foxglove-sdk, and of bridges that record IDL."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import foxglove.messages as fox  # pyright: ignore[reportMissingImports]
import pytest
from foxglove_server import BATTERY_IDL, CUSTOM
from mcap.writer import Writer

from webviz.data.foxglove import schemas
from webviz.data.messages import decode, encode, register
from webviz.data.recordings.mcap_writing import McapFile
from webviz.sources.bag.file import BagFile

TRANSFORM = fox.FrameTransform(
    timestamp=fox.Timestamp(sec=7, nsec=8), parent_frame_id="odom", child_frame_id="base"
).encode()
LOG = {"timestamp": {"sec": 7, "nsec": 8}, "level": 2, "message": "hello", "name": "robot"}

Fill = Callable[[Writer], None]


def bag(path: Path, fill: Fill) -> BagFile:
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        fill(writer)
        writer.finish()
    return BagFile(path)


def add(
    writer: Writer, topic: str, encoding: str, schema: str, *messages: bytes, text: str = ""
) -> None:
    kind = "ros2idl" if encoding == "cdr" else "protobuf"
    number = writer.register_schema(schema, kind, text.encode())
    channel = writer.register_channel(topic, encoding, number)
    for stamp_ns, data in enumerate(messages, 1):
        writer.add_message(channel, stamp_ns, data, stamp_ns)


def copy(file: BagFile, path: Path) -> BagFile:
    """Write all messages to another file, as for a span of the timeline."""
    mcap_file = McapFile(path, "test")
    channels = {(each.topic, each.type): each.written for each in file.channels}
    for message in file.messages(file.channels, 0):
        mcap_file.add(channels[message.topic, message.type], message.stamp_ns, message.cdr)
    mcap_file.close()
    return BagFile(path)


def test_schemas_of_foxglove_are_read_as_messages_of_ros(tmp_path: Path) -> None:
    def fill(writer: Writer) -> None:
        add(writer, "/tf", "protobuf", "foxglove.FrameTransform", TRANSFORM)
        add(writer, "/rosout", "json", "foxglove.Log", json.dumps(LOG).encode())

    file = bag(tmp_path / "run.mcap", fill)
    messages = {message.topic: message for message in file.messages(file.channels, 0)}
    assert messages["/tf"].type == "tf2_msgs/msg/TFMessage"
    (transform,) = decode(messages["/tf"].type, messages["/tf"].cdr).transforms
    assert (transform.parent, transform.child, transform.stamp_ns) == (
        "odom",
        "base",
        7_000_000_008,
    )
    assert decode(messages["/rosout"].type, messages["/rosout"].cdr).msg == "hello"
    assert [each.topic for each in file.newest(file.channels, 10)][-1] in ("/tf", "/rosout")
    assert not file.warnings
    copied = copy(file, tmp_path / "copy.mcap")
    assert {(each.recorded.type, each.recorded.encoding) for each in copied.channels} == {
        ("tf2_msgs/msg/TFMessage", "cdr"),
        ("rcl_interfaces/msg/Log", "cdr"),
    }
    assert {each.cdr for each in copied.messages(copied.channels, 0)} == {
        each.cdr for each in messages.values()
    }
    copied.close()
    file.close()


def test_unconvertible_messages_are_skipped_and_reported(tmp_path: Path) -> None:
    def fill(writer: Writer) -> None:
        add(writer, "/tf", "protobuf", "foxglove.FrameTransform", b"\xff\xff", TRANSFORM)

    file = bag(tmp_path / "run.mcap", fill)
    assert len(list(file.messages(file.channels, 0))) == 1
    assert file.warnings == [
        "/tf: A message is not a valid foxglove.FrameTransform; it is left out."
    ]
    file.close()


def test_unsupported_channels_are_listed_with_the_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fill(writer: Writer) -> None:
        add(writer, "/notes", "json", "foxglove.ImageAnnotations", b"{}")
        add(writer, "/two\nlines", "protobuf", "foxglove.FrameTransform", TRANSFORM)
        add(writer, "/tf", "protobuf", "foxglove.FrameTransform", TRANSFORM)

    file = bag(tmp_path / "run.mcap", fill)
    assert [channel.topic for channel in file.channels] == ["/tf"]
    assert "has no equal message in ROS" in file.skipped["/notes"]
    assert "invisible characters" in file.skipped["/two\nlines"]
    file.close()
    monkeypatch.setattr(schemas, "_is_installed", lambda: False)
    file = BagFile(tmp_path / "run.mcap")
    assert "ros-webviz[foxglove]" in file.skipped["/tf"]
    file.close()


def test_definitions_in_idl_are_read(tmp_path: Path) -> None:
    register(CUSTOM, BATTERY_IDL)
    battery = encode(CUSTOM, {"voltage": 12.5})
    name, text = (each.replace("my_robot_msgs", "idl_msgs") for each in (CUSTOM, BATTERY_IDL))
    file = bag(
        tmp_path / "run.mcap",
        lambda writer: add(writer, "/battery", "cdr", name, battery, text=text),
    )
    (message,) = file.messages(file.channels, 0)
    assert decode(message.type, message.cdr, message.types).voltage == 12.5
    copied = copy(file, tmp_path / "copy.mcap")
    assert [each.recorded for each in copied.channels] == [each.recorded for each in file.channels]
    copied.close()
    file.close()
