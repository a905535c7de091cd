"""Seeks where transforms come late, end, and start over: nodes and statuses of a straight play."""

from __future__ import annotations

import contextlib
import random
from pathlib import Path
from typing import Any

import pytest
from bags import START_NS, TF, Bag, Topic, ns, stamped

from webviz.commands import Reset, Seek, SetFixedFrame
from webviz.shell.testing import BagViewer, check_seeks, header


def stamped_behind(lag_s: float) -> Bag:
    """Transforms of 12 s whose stamps are behind the time of recording; those of one frame end."""
    bag = Bag()
    bag.add("/tf", TF)
    for step in range(24):
        at_s = step / 2
        stamp_ns = START_NS + ns(at_s - lag_s)
        moving = [stamped("map", "base", stamp_ns, at_s)]
        if at_s < 3.0:
            moving.append(stamped("base", "arm", stamp_ns, 1.0))
        bag.put(at_s, "/tf", {"transforms": moving})
    return bag


@pytest.mark.parametrize("lag_s", [0.0, 60.0, -3600.0])
def test_frames_age_from_when_they_were_received(tmp_path: Path, lag_s: float) -> None:
    config = "fixed_frame: map\ndisplays: [{type: TF, frame_timeout: 9}]\n"
    path = stamped_behind(lag_s).write_file(tmp_path / "run.mcap")
    check_seeks(path, config, times=[5.05, 1.0, 11.3, 8.2, 2.9])


DISPLAYS = """\
displays:
- {type: LaserScan, topic: /scan}
- {type: LaserScan, topic: {name: /scan, filter_size: 100}, decay_time: 1.5, name: Decaying}
- {type: PointStamped, topic: {name: /point, filter_size: 100}, history_length: 5}
- {type: Path, topic: /path, buffer_length: 2}
- {type: Odometry, topic: {name: /odom, filter_size: 100}, keep: 9, position_tolerance: 0.3}
- {type: Marker, topic: /marker}
- {type: MarkerArray, topic: /markers}
- {type: Map, topic: /map, use_timestamp: true}
- {type: TF, frame_timeout: 9}
"""
"""Displays that accumulate, or that look back."""


def marker(frame: str, stamp_ns: int, number: int, x: float) -> dict[str, Any]:
    """Return a cube."""
    pose = {"position": {"x": x}, "orientation": {"w": 1.0}}
    color, scale = {"r": 1.0, "a": 1.0}, {"x": 1.0, "y": 1.0, "z": 1.0}
    head = header(frame, stamp_ns)
    return {"header": head, "ns": "m", "id": number, "type": 1, "pose": pose} | {
        "color": color,
        "scale": scale,
    }


def troubled(seed: int) -> Bag:
    """16 s of a robot whose transforms come late and seldom, end, and start over."""
    chance = random.Random(seed)
    bag = Bag()
    bag.add("/scan", "sensor_msgs/msg/LaserScan", best_effort=True)
    bag.add("/point", "geometry_msgs/msg/PointStamped")
    bag.add("/path", "nav_msgs/msg/Path")
    bag.add("/odom", "nav_msgs/msg/Odometry")
    bag.add("/marker", "visualization_msgs/msg/Marker")
    bag.add("/markers", "visualization_msgs/msg/MarkerArray")
    bag.add("/map", "nav_msgs/msg/OccupancyGrid")
    bag.transform(chance.uniform(0.0, 2.0), "base", "laser", static=True)
    period_s = chance.choice([0.1, 0.4, 0.7])
    late_s = chance.choice([0.0, 0.05, 0.35])
    first_s, end_s = chance.uniform(0.0, 3.0), chance.uniform(6.0, 8.0)
    again_s = chance.uniform(10.0, 13.0)
    at_s = 0.0
    while at_s < 16.0:
        if first_s < at_s < end_s or at_s > again_s:
            stamp_ns = START_NS + ns(at_s)
            bag.put(at_s + late_s, "/tf", {"transforms": [stamped("map", "odom", stamp_ns, at_s)]})
        at_s += period_s
    bag.topics["/tf"] = Topic(TF)
    info = {"resolution": 1.0, "width": 2, "height": 2, "origin": {"orientation": {"w": 1}}}
    for step in range(160):
        at_s = step / 10 + 0.013
        stamp_ns = START_NS + ns(at_s)
        bag.transform(at_s + 0.011, "odom", "base", x=at_s)
        ranges = {"angle_increment": 0.1, "range_max": 9.0, "ranges": [1.0 + at_s % 5, 2.0]}
        bag.put(at_s, "/scan", {"header": header("laser", stamp_ns), **ranges})
        pose = {"pose": {"position": {"x": at_s / 2}, "orientation": {"w": 1.0}}}
        bag.put(at_s + 0.002, "/odom", {"header": header("odom", stamp_ns), "pose": pose})
        if chance.random() < 0.3:
            number = chance.randrange(5)
            bag.put(at_s + 0.003, "/marker", marker("base", stamp_ns, number, at_s))
        if chance.random() < 0.3:
            some = [marker("odom", stamp_ns, number, at_s) for number in range(chance.randrange(4))]
            is_end = chance.random() < 0.05
            array = [{**marker("odom", stamp_ns, 0, 0.0), "action": 3}] if is_end else some
            bag.put(at_s + 0.004, "/markers", {"markers": array})
        if chance.random() < 0.2:
            point = {"header": header("laser", stamp_ns), "point": {"x": at_s}}
            bag.put(at_s + 0.005, "/point", point)
        if chance.random() < 0.1:
            place = {"header": header("base", stamp_ns), "pose": pose["pose"]}
            path = {"header": header("base", stamp_ns), "poses": [place, place]}
            bag.put(at_s + 0.006, "/path", path)
    for at_s in (0.5, 5.0):
        head = header("odom", START_NS + ns(at_s))
        bag.put(at_s, "/map", {"header": head, "info": info, "data": [round(at_s)] * 4})
    return bag


@pytest.mark.parametrize("seed", range(5))
def test_transforms_come_late_end_and_start_over(tmp_path: Path, seed: int) -> None:
    path = troubled(seed).write_file(tmp_path / "run.mcap")
    check_seeks(path, f"fixed_frame: map\n{DISPLAYS}", count=7, seed=seed)


def test_between_two_transforms_the_last_message_that_one_places_is_shown(tmp_path: Path) -> None:
    bag = Bag()
    bag.add("/point", "geometry_msgs/msg/PointStamped")
    for step in range(400):  # more wait for the next transform than are held
        at_s = step / 50
        if step % 40 == 0:
            bag.transform(at_s, "map", "base", x=at_s)
        head = header("base", START_NS + ns(at_s))
        bag.put(at_s + 0.01, "/point", {"header": head, "point": {"x": at_s}})
    path = bag.write_file(tmp_path / "run.mcap")
    config = "fixed_frame: map\ndisplays: [{type: PointStamped, topic: /point}]\n"
    check_seeks(path, config, times=[5.55, 2.35, 7.15])


TIME = Path(__file__).parents[4] / "shared/data/reports/time"
"""Bags with which seeks once showed other things than playing."""
REPORTS = [
    ("plain", "mk.yaml", [3.492, 12.63, 1.399, 14.8]),
    ("late_static", "", [14.8, 2.0, 6.699, 13.9]),
    ("late_tf", "", [5.0, 0.4, 9.7]),
    ("equal", "mk.yaml", [6.1, 0.227, 3.596]),
    ("stamp_minus_60s", "tf.yaml", [5.05, 0.3, 8.0]),
    ("stamp_plus_1h", "tf.yaml", [5.05, 0.3]),
    ("split", "", [9.95, 20.0, 3600.4, 1800.0]),
]


@pytest.mark.parametrize(("name", "config", "times"), REPORTS)
def test_seeks_of_reports(name: str, config: str, times: list[float]) -> None:
    if not TIME.exists():
        pytest.skip("the bags of the report are not on this machine")
    path = TIME / "syn" / name
    text = (TIME / config).read_text() if config else None
    check_seeks(path if path.is_dir() else path.with_suffix(".mcap"), text, times=times)


def statuses(viewer: BagViewer, key: str) -> tuple[str, str]:
    """Return the level and text of a status of the only display."""
    status = viewer.rows[0].statuses[key]
    return status.level.name, status.text


def test_messages_that_were_given_up_are_an_error_wherever_one_comes_from(tmp_path: Path) -> None:
    bag = Bag()
    bag.add("/scan", "sensor_msgs/msg/LaserScan")
    bag.transform(0, "odom", "base")
    for step in range(120):
        ranges = {"angle_increment": 0.1, "range_max": 9.0, "ranges": [1.0, 2.0]}
        head = header("base", START_NS + ns(step / 20))
        bag.put(step / 20, "/scan", {"header": head, **ranges})
    config = "fixed_frame: map\ndisplays: [{type: LaserScan}]\n"
    path = bag.write_file(tmp_path / "run.mcap")
    check_seeks(path, config, times=[5.0, 0.4, 3.0])
    with contextlib.closing(BagViewer(path, config)) as viewer:
        viewer.do(Seek(5.0))
        level, text = statuses(viewer, "Transform")
        assert (level, "Earlier ones were given up." in text) == ("ERROR", True)


def test_rates_are_those_of_the_recording(tmp_path: Path) -> None:
    """Also of a display that reads only some messages of the past, or one."""
    bag = Bag()
    bag.add("/odom", "nav_msgs/msg/Odometry")
    bag.add("/words", "std_msgs/msg/String")
    for step in range(400):
        pose = {"pose": {"position": {"x": step / 100}, "orientation": {"w": 1.0}}}
        head = header("odom", START_NS + ns(step / 20))
        bag.put(step / 20, "/odom", {"header": head, "pose": pose})
        bag.put(step / 20, "/words", {"data": str(step)})
    path = bag.write_file(tmp_path / "run.mcap")
    for display in ("{type: Odometry}", "{type: Text, topic: /words}"):
        config = f"fixed_frame: odom\ndisplays: [{display}]\n"
        with contextlib.closing(BagViewer(path, config)) as viewer:
            viewer.do(Seek(15.0))
            assert statuses(viewer, "Topic")[1].startswith("More than 50 messages at 20.0 Hz")
            viewer.do(Seek(0.52))
            assert statuses(viewer, "Topic")[1].startswith("11 messages at 20.0 Hz")


def test_frames_keep_their_age_in_another_fixed_frame_and_after_a_reset(tmp_path: Path) -> None:
    config = "fixed_frame: map\ndisplays: [{type: TF}]\n"
    path = stamped_behind(60.0).write_file(tmp_path / "run.mcap")
    with contextlib.closing(BagViewer(path, config)) as viewer:
        viewer.do(Seek(11.0))
        assert statuses(viewer, "Frames") == ("OK", "3 frames shown.")
        viewer.do(SetFixedFrame("base"))
        assert statuses(viewer, "Frames") == ("OK", "3 frames shown.")
        viewer.do(Reset())
        viewer.play_to(11.9)
        assert statuses(viewer, "Frames")[1].startswith("2 of 3 frames shown, 1 have no transform")


def test_a_marker_of_long_ago_is_where_its_frame_was(tmp_path: Path) -> None:
    bag = Bag()
    bag.add("/markers", "visualization_msgs/msg/MarkerArray")
    for step in range(200):
        bag.transform(step / 5, "map", "base", x=step / 5)
    for at_s in (3.1, 7.3):
        one = marker("base", START_NS + ns(at_s), round(at_s), 0.5)
        bag.put(at_s, "/markers", {"markers": [one]})
    config = "fixed_frame: map\ndisplays: [{type: MarkerArray, topic: /markers}]\n"
    check_seeks(bag.write_file(tmp_path / "run.mcap"), config, times=[39.0, 25.0, 5.0])
