"""Bags as a user opens them: several at once, without a config, from Python, with mistakes."""

from __future__ import annotations

import math
import struct
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from bags import START_NS, Bag, ns, strings
from rosbags.rosbag2 import StoragePlugin
from waiting import until

import webviz
from tests.scene.conftest import Peer
from tests.support.guest import Served
from webviz.api.declared import Topic
from webviz.api.views import Orbit
from webviz.data.messages import decode, encode, register
from webviz.shell.app.bag_config import config_of, fixed_frame_of, robot_frame_of
from webviz.shell.cli import main as cli
from webviz.shell.testing import header
from webviz.sources import Subscription
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

CDR = b"\0\1\0\0"


def robot() -> Bag:
    """A robot with two lasers, a camera, and a topic without a publisher."""
    bag = Bag()
    for topic, message, frame in (
        ("/front/scan", "LaserScan", "front"),
        ("/rear/scan", "LaserScan", "rear"),
        ("/camera/image_raw", "Image", "camera"),
        ("/camera/image_raw/compressed", "CompressedImage", "camera"),
        ("/camera/camera_info", "CameraInfo", "camera"),
    ):
        bag.add(topic, f"sensor_msgs/msg/{message}")
        bag.put(0.5, topic, {"header": header(frame, START_NS)})
    bag.add("/joint_states", "sensor_msgs/msg/JointState")
    bag.put(0.5, "/joint_states", {"header": header("", START_NS)})
    bag.transform(0.0, "base", "front", static=True)
    bag.transform(0.1, "odom", "base")
    bag.transform(1.0, "odom", "base")
    return bag


def topic_statuses(bag: BagHistory) -> dict[str, str]:
    """Names and types of the displays for a bag."""
    return {each.name: type(each).__name__ for each in config_of(bag).displays}  # pyright: ignore[reportAttributeAccessIssue]


def test_without_a_config_the_topics_of_a_bag_are_shown(tmp_path: Path) -> None:
    source = BagHistory(robot().write(tmp_path / "run"))
    assert topic_statuses(source) == {
        "Grid": "Grid",
        "TF": "TF",
        "/front/scan": "LaserScan",
        "/rear/scan": "LaserScan",
        "Image": "Image",
    }
    settings = config_of(source).settings
    assert settings.fixed_frame == "odom"
    assert settings.view == Orbit(target_frame="base")
    source.close()


@pytest.mark.parametrize(
    ("links", "robot"),
    [
        (
            [("map", "odom"), ("odom", "base_footprint"), ("base_footprint", "base_link")],
            "base_link",
        ),
        ([("map", "r2/base_link"), ("map", "r1/base_link")], "r1/base_link"),
        ([("base_link", "laser")], ""),
        ([("map", "odom"), ("world", "base_link")], ""),
    ],
)
def test_the_view_follows_a_robot_that_moves_in_the_fixed_frame(
    links: list[tuple[str, str]], robot: str
) -> None:
    assert robot_frame_of(links, fixed_frame_of(links)) == robot


def test_without_transforms_the_fixed_frame_is_that_of_the_data(tmp_path: Path) -> None:
    bag = Bag()
    for topic, frame in (("/imu", "imu_link"), ("/odom", "map")):
        bag.add(topic, "nav_msgs/msg/Odometry")
        bag.put(0, topic, {"header": header(frame, START_NS)})
    source = BagHistory(bag.write(tmp_path / "run"))
    assert config_of(source).settings.fixed_frame == "map"
    source.close()


def test_several_bags_are_one(tmp_path: Path, theater: Callable) -> None:
    first = strings(0, 2).write(tmp_path / "first")
    second = strings(1, 5).write(tmp_path / "second")
    viewer = theater([second, first, first], "displays: [{type: Text, topic: /words}]")
    playback = viewer.playback
    assert set(playback.names) == {"first", "second"}
    assert playback.end_ns - playback.start_ns == ns(5)
    viewer.source.want({"/words": Subscription("std_msgs/msg/String", Topic("/words"))})
    viewer.source.inbox.drain()
    viewer.source.jump(START_NS)
    while viewer.source.reached_ns < START_NS + ns(3):
        viewer.source.play_until(START_NS + ns(3))
    payloads = [raw.cdr for raw in viewer.source.inbox.drain()["/words"]]
    assert payloads == [encode("std_msgs/msg/String", {"data": text}) for text in "012"]


@pytest.mark.parametrize(
    ("count", "more"),
    [(1, ""), (2, ", and so does 1 more topic"), (3, ", and so do 2 more topics")],
)
def test_types_that_differ_between_bags_are_reported(
    tmp_path: Path, theater: Callable, count: int, more: str
) -> None:
    first, other = strings(0), Bag()
    for topic in ("/words", "/a", "/b")[:count]:
        first.add(topic, "std_msgs/msg/String")
        other.add(topic, "std_msgs/msg/Bool")
        other.put(0, topic, {"data": True})
    viewer = theater([first.write(tmp_path / "first"), other.write(tmp_path / "second")])
    assert viewer.loop.state().statuses["Bag"].text == (
        "/words differs between the bags, std_msgs/msg/String in first and std_msgs/msg/Bool in "
        f"second{more}: a display reads one type only."
    )


def test_bags_that_lie_far_apart_are_reported(tmp_path: Path, theater: Callable) -> None:
    days = strings(100 * 86_400).write(tmp_path / "late")
    viewer = theater([days, strings(0).write(tmp_path / "early")])
    assert viewer.loop.state().statuses["Bag"].text == (
        "late begins 100 days after early ends, with nothing in between: play them one by one, or "
        "select a span of the timeline."
    )


APPLE, BASKET = "fruit_of_topics/msg/Apple", "fruit_of_topics/msg/Basket"
PART = f"{'=' * 80}\nMSG: fruit_of_topics/Apple\n"
NUMBER = struct.pack("<i", 7), struct.pack("<f", 0.5)


def arrived(player: Player, types: Mapping[str, str]) -> dict[str, Any]:
    """Play all of a recording, and return the messages by topic."""
    player.want({topic: Subscription(type_, Topic(topic)) for topic, type_ in types.items()})
    assert [offer.problem for offer in player.offers().values()] == [""] * len(types)
    player.play_until(player.history.end_ns)
    raws = {topic: raw for topic, (raw,) in player.inbox.drain().items()}
    return {topic: decode(types[topic], raw.cdr, raw.types) for topic, raw in raws.items()}


@pytest.mark.parametrize("is_last", [False, True])
def test_each_topic_is_read_by_its_own_definition(tmp_path: Path, is_last: bool) -> None:
    """Although they define a type in each other, and one that is known, otherwise."""
    whole, half = NUMBER
    topics = {
        "/apple": (APPLE, "int32 weight\n", whole),
        "/basket": (BASKET, f"Apple apple\n{PART}float32  weight  # in kg\n", half),
        "/crate": ("fruit_of_topics/msg/Crate", f"Apple[] apples\n{PART}int16 weight\n", b""),
    }
    live = "fruit_of_topics/msg/Live"
    register(live, f"Apple apple\n{PART}uint8 weight\n")
    bag = Bag()
    for topic, (type_name, definition, number) in sorted(topics.items(), reverse=is_last):
        bag.add(topic, type_name, definition=definition)
        bag.put(0, topic, CDR + (number or struct.pack("<ihh", 2, 1, -1)))
    player = Player(BagHistory(bag.write(tmp_path / "run")))
    arrivals = arrived(player, {topic: type_ for topic, (type_, _, _) in topics.items()})
    assert arrivals["/apple"].weight == 7
    assert arrivals["/basket"].apple.weight == 0.5
    assert [apple.weight for apple in arrivals["/crate"].apples] == [1, -1]
    assert decode(live, CDR + b"\x07").apple.weight == decode(APPLE, CDR + b"\x07").weight == 7
    player.close()


def test_bags_and_live_topics_may_define_a_type_otherwise(tmp_path: Path) -> None:
    paths = []
    for topic, kind, number in zip(
        ("/first", "/second"), ("int32", "float32"), NUMBER, strict=True
    ):
        bag = Bag()
        bag.add(topic, BASKET, definition=f"Apple apple\n{PART}{kind} weight\n")
        bag.put(0, topic, CDR + number)
        paths.append(bag.write(tmp_path / topic[1:]))
    together, alone = Player(BagHistory(paths)), Player(BagHistory(paths[0]))
    register(BASKET, f"Apple apple\n{PART}uint8 weight\n")
    assert arrived(alone, {"/first": BASKET})["/first"].apple.weight == 7
    arrivals = arrived(together, {"/first": BASKET, "/second": BASKET})
    assert [each.apple.weight for each in arrivals.values()] == [7, 0.5]
    assert decode(BASKET, CDR + b"\x09").apple.weight == 9
    alone.close()
    together.close()


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_program_plays_a_bag(tmp_path: Path, storage: StoragePlugin) -> None:
    path = strings(0, 1, 2, 3, 4).write(tmp_path / "run", storage)
    with webviz.Viewer(bag=path, port=0) as viewer:
        assert viewer.span == (START_NS / 1e9, START_NS / 1e9 + 4)
        assert viewer.position == 0.0
        viewer.add("Text", topic="/words")
        viewer.seek("end")
        assert viewer.position == 4.0
        assert "Bag" not in viewer.statuses  # which would report damage
        viewer.seek(viewer.span[0] + 1)
        assert viewer.position == 1.0
        with pytest.raises(webviz.Error, match=r"7 s is outside of run\. Give 0 to 4 s"):
            viewer.seek(7)
        for value in ([1], None, b"end", {}):
            with pytest.raises(webviz.Error, match=r"is not a valid time\. Give seconds"):
                viewer.seek(value)  # pyright: ignore[reportArgumentType]
        viewer.play(rate=0.01)
        viewer.pause()
        assert 1.0 <= viewer.position < 4.0
        viewer.play(rate=math.inf)
        until(lambda: viewer.position == 4.0)
        with pytest.raises(webviz.Error, match="rate -1 is out of range"):
            viewer.play(rate=-1)


def test_a_bag_needs_no_ros(tmp_path: Path) -> None:
    path = robot().write(tmp_path / "run")
    script = (
        "import sys; sys.modules['rclpy'] = None; import webviz\n"
        f"with webviz.Viewer(bag={str(path)!r}, port=0) as viewer: print(viewer.fixed_frame)"
    )
    completed = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert (completed.stdout, completed.stderr) == ("odom\n", "")


def test_it_plays_once_a_browser_connects(tmp_path: Path) -> None:
    path = strings(0, 1, 2).write(tmp_path / "run")
    with webviz.Viewer(bag=path, port=0, autoplay=True) as viewer:
        assert viewer.position == 0.0
        peer = Peer(Served(viewer.port))
        peer.look()
        until(lambda: viewer.position == 2.0)
        peer.close()


MISTAKES = [
    (["--bag", "nowhere.mcap"], 1, "Bag nowhere.mcap not found. Give an MCAP or db3 file"),
    (["--bag", __file__], 1, "is a text, not a bag."),
    (["--bag"], 2, "--bag needs FILE."),
    (["--paused"], 2, "--paused needs --bag."),
    (["--bag", "{run}", "--ros-args", "-p", "use_sim_time:=true"], 1, "not supported with a bag"),
]


@pytest.mark.parametrize(
    ("arguments", "status", "sentence"), MISTAKES, ids=lambda each: str(each)[:30]
)
def test_a_mistake_is_one_sentence(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    status: int,
    sentence: str,
) -> None:
    path = strings(0).write(tmp_path / "run")
    assert cli([each.format(run=path) for each in arguments]) == status
    output = capsys.readouterr().err
    assert output.startswith("webviz: ")
    assert sentence in output
    assert output.count("\n") == 1
