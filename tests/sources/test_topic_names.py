"""Topics whose names ROS 2 forbids but bags have."""

from __future__ import annotations

from pathlib import Path

import pytest
from bags import strings
from mcap.writer import Writer
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.typesys import Stores, get_typestore

from webviz.shell.testing import BagViewer
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

TIME = Path(__file__).parents[3] / "shared/data/reports/time/syn/topic_names.mcap"
ODD = ["/front-lidar/words", "/words.raw", "/2d_words", "/a b", "/words/"]


def display_statuses(bag: Path, topic: str) -> dict[str, str]:
    """Return the levels and texts of a display of strings at the end of a bag."""
    viewer = BagViewer(bag, f"displays: [{{type: Text, topic: {topic!r}}}]")
    try:
        viewer.play_to(2.0)
        viewer.settle()
        return {key: f"{s.level.name} {s.text}" for key, s in viewer.rows[0].statuses.items()}
    finally:
        viewer.close()


def mcap(path: Path, topics: list[str]) -> Path:
    """Write strings as other programs do, which know no rules for names."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data")
        for topic in topics:
            channel = writer.register_channel(topic, "cdr", schema)
            data = b"\0\1\0\0\6\0\0\0hello\0"
            writer.add_message(channel, 10**18, data, 10**18)
        writer.finish()
    return path


@pytest.mark.parametrize("name", ODD)
def test_a_name_that_is_in_the_bag_is_valid_there(tmp_path: Path, name: str) -> None:
    result = display_statuses(mcap(tmp_path / "run.mcap", ODD), name)
    assert result["Topic"].startswith("OK 1 message")


@pytest.mark.parametrize("name_in_file", ["words", "/words"])
def test_a_name_without_a_slash_is_that_of_a_topic_with_one(
    tmp_path: Path, name_in_file: str
) -> None:
    path = mcap(tmp_path / "run.mcap", ["words"])
    assert display_statuses(path, name_in_file)["Topic"].startswith("OK 1 message")
    source = Player(BagHistory(path))
    assert list(source.offers()) == ["/words"]
    source.close()


def test_topics_that_differ_by_a_slash_stay_apart(tmp_path: Path) -> None:
    path = mcap(tmp_path / "run.mcap", ["words", "/words"])
    assert display_statuses(path, "words")["Topic"].startswith("OK 1 message")
    assert display_statuses(path, "/words")["Topic"].startswith("OK 1 message")


def test_names_of_ros_1_are_valid(tmp_path: Path) -> None:
    path, store = tmp_path / "run.bag", get_typestore(Stores.ROS1_NOETIC)
    with Ros1Writer(path) as writer:
        connection = writer.add_connection(
            "/front-lidar/words", "std_msgs/msg/String", typestore=store
        )
        String = store.types["std_msgs/msg/String"]
        data = store.serialize_ros1(String("hello"), "std_msgs/msg/String")
        writer.write(connection, 10**18, data)
    assert display_statuses(path, "/front-lidar/words")["Topic"].startswith("OK 1 message")


def test_names_that_are_not_in_the_bag_are_still_refused(tmp_path: Path) -> None:
    result = display_statuses(strings(0, 1).write_file(tmp_path / "run.mcap"), "/front-lidar/words")
    assert "is not a valid topic name" in result["Topic"]


def test_displays_of_a_bag_of_a_report_are_ok() -> None:
    if not TIME.exists():
        pytest.skip("the bag of the report is not on this machine")
    viewer = BagViewer(TIME)
    viewer.play_to(2.0)
    viewer.settle()
    scans = [row for row in viewer.rows if row.type == "LaserScan" and row.statuses]
    assert len(scans) >= 3
    for row in scans:
        assert row.statuses["Topic"].level.name == "OK", row.name
    viewer.close()
