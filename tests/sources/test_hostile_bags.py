"""Bags with definitions that are made to harm: their topics are refused, all others play."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from bags import Bag
from hostile_definitions import NAME, READ, REFUSED, renamed
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import StoragePlugin

from webviz.api.declared import Topic
from webviz.data.messages import decode, encode
from webviz.data.messages.typestore import is_idl
from webviz.sources import Subscription
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

Write = Callable[[Path], tuple[Path, Mapping[str, str]]]
STRING = "std_msgs/msg/String"
TEXTS = {name: text for name, (text, _) in REFUSED.items()}
PLAIN = {name: text for name, text in TEXTS.items() if not is_idl(text)}
ROS_1_LIMITS = ("many types",)
"""Refused of ROS 2 only, as ROS 1 makes no class of a type."""


def mcap(path: Path) -> tuple[Path, Mapping[str, str]]:
    topics = {f"/evil{number}": name for number, name in enumerate(TEXTS)}
    with path.open("wb") as file:
        writer = McapWriter(file)
        writer.start("ros2")
        data = {"/words": (STRING, "string data", "ros2msg")}
        for number, (topic, name) in enumerate(topics.items()):
            package = f"evil{number}_mcap_msgs"
            text = renamed(TEXTS[name], package)
            kind = "ros2idl" if is_idl(text) else "ros2msg"
            data[topic] = renamed(NAME, package), text, kind
        for topic, (type_, text, kind) in data.items():
            schema = writer.register_schema(type_, kind, text.encode())
            channel = writer.register_channel(topic, "cdr", schema)
            writer.add_message(channel, 1, encode(STRING, {"data": "hello"}), 1)
        writer.finish()
    return path, topics


def db3(path: Path) -> tuple[Path, Mapping[str, str]]:
    topics = {f"/evil{number}": name for number, name in enumerate(PLAIN)}
    bag = Bag()
    bag.add("/words", STRING)
    bag.put(0.0, "/words", {"data": "hello"})
    for number, (topic, name) in enumerate(topics.items()):
        package = f"evil{number}_db3_msgs"
        bag.add(topic, renamed(NAME, package), definition=renamed(PLAIN[name], package))
        bag.put(0.0, topic, encode(STRING, {"data": "hello"}))
    return bag.write(path.with_suffix(""), StoragePlugin.SQLITE3), topics


def ros1(path: Path) -> tuple[Path, Mapping[str, str]]:
    names = [name for name in PLAIN if name not in ROS_1_LIMITS]
    topics = {f"/evil{number}": name for number, name in enumerate(names)}
    path = path.with_suffix(".bag")
    with Ros1Writer(path) as writer:
        data = {"/words": (STRING, "string data")}
        for number, (topic, name) in enumerate(topics.items()):
            package = f"evil{number}_ros1_msgs"
            data[topic] = renamed(NAME, package), renamed(PLAIN[name], package)
        for topic, (type_, text) in data.items():
            connection = writer.add_connection(topic, type_, msgdef=text, md5sum="0" * 32)
            writer.write(connection, 1, b"\5\0\0\0hello")
    return path, topics


@pytest.mark.parametrize("write", [mcap, db3, ros1])
def test_a_bag_with_hostile_definitions_plays_everything_else(tmp_path: Path, write: Write) -> None:
    path, topics = write(tmp_path / "run.mcap")
    source = Player(BagHistory(path))
    offers = source.offers()
    for topic, name in topics.items():
        problem = offers[topic].problem
        if write is ros1:
            assert "ros1" in problem
        else:
            assert REFUSED[name][1] in problem
        assert len(problem) < 300
    source.want({"/words": Subscription(STRING, Topic("/words"))})
    source.play_step(source.history.end_ns)
    (raw,) = source.inbox.drain()["/words"]
    assert decode(STRING, raw.cdr).data == "hello"
    source.close()


@pytest.mark.parametrize("what", READ)
def test_messages_of_few_bytes_that_become_much_are_played(tmp_path: Path, what: str) -> None:
    package = f"evil_read{list(READ).index(what)}_msgs"
    type_ = renamed(NAME, package)
    bag = Bag()
    bag.add("/evil", type_, definition=renamed(READ[what], package))
    bag.put(0.0, "/evil", b"\0\1\0\0" + b"\xff" * 100)
    source = Player(BagHistory(bag.write_file(tmp_path / "run.mcap")))
    assert not source.offers()["/evil"].problem
    source.want({"/evil": Subscription(type_, Topic("/evil"))})
    source.play_step(source.history.end_ns)
    assert len(list(source.inbox.drain()["/evil"])) == 1
    source.close()
