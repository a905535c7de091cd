"""Seeks where transforms come late, end, and start over: nodes and statuses of a straight play."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
from bags import START_NS, TF, Bag, Topic, ns, stamped

from webviz.shell.testing import check_seeks, header


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


@pytest.mark.parametrize("seed", range(6))
def test_transforms_come_late_end_and_start_over(tmp_path: Path, seed: int) -> None:
    path = troubled(seed).write_file(tmp_path / "run.mcap")
    check_seeks(path, f"fixed_frame: map\n{DISPLAYS}", count=10, seed=seed)
