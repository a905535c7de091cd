"""A bag before its first messages: when they come, instead of which nodes to start."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest
from bags import START_NS, Bag, ns

from webviz.api.status import Level
from webviz.commands import Seek
from webviz.shell.testing import BagViewer, header

CONFIG = """\
fixed_frame: map
displays:
- {type: TF}
- {type: Odometry}
- {type: LaserScan}
- {type: RobotModel}
"""


def texts(path: Path, to_s: float) -> list[str]:
    """All statuses that are not OK, after some seconds of a bag."""
    with closing(BagViewer(path, CONFIG)) as viewer:
        viewer.play_to(to_s)
        state = viewer.loop.state()
    result = [*state.statuses.values()]
    result += [status for row in state.rows for status in row.statuses.values()]
    return [status.text for status in result if status.level.name != "OK"]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    bag = Bag()
    bag.add("/words", "std_msgs/msg/String")
    bag.add("/odom", "nav_msgs/msg/Odometry")
    bag.put(0, "/words", {"data": "first"})
    bag.put(1.25, "/odom", {"header": {"frame_id": "map"}})
    bag.transform(0.75, "map", "base")
    return bag.write_file(tmp_path / "bag.mcap")


def test_statuses_before_the_first_messages_of_a_bag_give_their_times(path: Path) -> None:
    result = texts(path, 0.0)
    assert "No transforms yet, so map is unknown: the bag's first is at 0.8 s." in result
    assert "No transforms yet: the bag's first is at 0.8 s." in result
    assert "No message yet on /odom: the bag's first is at 1.2 s." in result
    assert "The bag has no topic /scan. Choose another topic." in result
    assert "No robot description received on /robot_description." in result
    assert not [text for text in result if "Start" in text]


def test_statuses_of_missing_messages_end_with_the_first_message(path: Path) -> None:
    assert not [text for text in texts(path, 1.3) if "yet" in text]


def test_a_bag_without_transforms_is_reported(tmp_path: Path) -> None:
    bag = Bag()
    bag.add("/odom", "nav_msgs/msg/Odometry")
    bag.add("/tf", "tf2_msgs/msg/TFMessage")
    pose = {"pose": {"orientation": {"w": 1.0}}}
    bag.put(0, "/odom", {"header": {"frame_id": "odom"}, "pose": pose})
    result = texts(bag.write_file(tmp_path / "bag.mcap"), 0.0)
    assert "No transforms yet, so map is unknown: the bag has none." in result
    assert 'No transforms yet, so "odom" has no pose in "map": the bag has none.' in result


@pytest.mark.parametrize("start_ns", [0, 1])
def test_a_bag_whose_time_begins_at_zero_needs_no_clock(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, start_ns: int
) -> None:
    monkeypatch.setattr("bags.START_NS", start_ns)
    bag = Bag()
    bag.add("/words", "std_msgs/msg/String")
    bag.put(0, "/words", {"data": "first"})
    path = bag.write_file(tmp_path / "bag.mcap")
    assert not [text for text in texts(path, 0.0) if "/clock" in text or "use_sim_time" in text]


def test_waiting_for_transforms_that_a_bag_does_not_have_is_an_error_after_a_seek_too(
    tmp_path: Path,
) -> None:
    bag = Bag()
    bag.add("/imu", "sensor_msgs/msg/Imu")
    for number in range(250):
        at_s = number / 50
        imu = {"header": header("imu", START_NS + ns(at_s)), "orientation": {"w": 1.0}}
        bag.put(at_s, "/imu", imu)
    path = bag.write_file(tmp_path / "bag.mcap")
    config = "fixed_frame: map\ndisplays: [{type: Imu, topic: /imu}]\n"
    with closing(BagViewer(path, config)) as sought, closing(BagViewer(path, config)) as played:
        sought.do(Seek(4.0))
        played.play_to(4.0)
        levels = [v.rows[0].statuses["Transform"].level for v in (sought, played)]
    assert levels == [Level.ERROR, Level.ERROR]
