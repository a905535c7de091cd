"""After a seek the scene equals that of a straight play to the same time, node by node."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
from bags import START_NS, Bag, ns

from webviz.engine import loop
from webviz.engine.commands import Seek
from webviz.shell.testing import header

CONFIG = """\
fixed_frame: map
displays:
- {type: LaserScan, decay_time: 1.2}
- {type: Odometry, keep: 7, position_tolerance: 0.25}
- {type: Map}
- {type: TF}
- {type: Axes, reference_frame: late}
- {type: Path, buffer_length: 3}
- {type: MarkerArray, topic: /markers}
"""
CELLS = 4


def grid(value: int) -> dict:
    info = {"resolution": 1.0, "width": CELLS, "height": CELLS, "origin": {"orientation": {"w": 1}}}
    return {"header": header("map", START_NS), "info": info, "data": [value] * CELLS * CELLS}


def markers(at_s: float, step: int) -> dict:
    common = {"header": header("map", START_NS + ns(at_s)), "ns": "box", "type": 1}
    if step % 20 == 19:
        return {"markers": [{**common, "action": 3}]}
    marker = {
        **common,
        "id": step % 7,
        "action": 2 if step % 5 == 4 else 0,
        "pose": {"position": {"x": at_s}, "orientation": {"w": 1.0}},
        "scale": {"x": 1.0, "y": 1.0, "z": 1.0},
        "color": {"r": 1.0, "a": 1.0},
        "lifetime": {"sec": step % 3},
    }
    return {"markers": [marker]}


def recorded() -> Bag:
    """Six seconds of a robot that drives."""
    bag = Bag()
    bag.add("/scan", "sensor_msgs/msg/LaserScan", best_effort=True)
    bag.add("/odom", "nav_msgs/msg/Odometry")
    bag.add("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
    bag.add("/map_updates", "map_msgs/msg/OccupancyGridUpdate")
    bag.add("/path", "nav_msgs/msg/Path", latched=True, depth=2)
    bag.add("/markers", "visualization_msgs/msg/MarkerArray")
    bag.transform(0, "map", "odom", static=True)
    bag.transform(3.05, "base", "late", static=True)
    bag.put(0, "/map", grid(0))
    bag.put(4.2, "/map", grid(50))
    for step in range(60):
        at_s = step / 10
        stamp_ns = START_NS + ns(at_s)
        # The transform comes after the data that needs it, as it does on robots.
        ranges = {"angle_increment": 0.1, "range_max": 9.0, "ranges": [1.0 + at_s, 2.0, 3.0]}
        bag.put(at_s, "/scan", {"header": header("base", stamp_ns), **ranges})
        pose = {"pose": {"position": {"x": at_s}, "orientation": {"w": 1.0}}}
        bag.put(at_s + 0.01, "/odom", {"header": header("odom", stamp_ns), "pose": pose})
        bag.transform(at_s + 0.03, "odom", "base", x=at_s)
        bag.put(at_s + 0.05, "/markers", markers(at_s, step))
        if step % 10 == 5:
            x = step // 10 % CELLS
            update = {"x": x, "y": 1, "width": 1, "height": 1, "data": [100]}
            bag.put(at_s, "/map_updates", {"header": header("map", stamp_ns), **update})
            place = {"header": header("map", stamp_ns), **pose}
            bag.put(at_s, "/path", {"header": header("map", stamp_ns), "poses": [place, place]})
    return bag


def test_a_seek_shows_what_a_straight_play_shows(theater: Callable) -> None:
    sought = theater(recorded(), CONFIG)
    path = sought.paths
    chance = random.Random(7)
    for _ in range(12):
        at_s = round(chance.uniform(0.0, 6.0), 3)
        sought.do(Seek(at_s))
        straight = theater(path, CONFIG)
        straight.do(Seek(at_s))
        assert straight.nodes()
        assert sought.nodes() == straight.nodes(), at_s
        statuses = [
            [(row.name, row.level) for row in each.loop.state().rows] for each in (sought, straight)
        ]
        assert statuses[0] == statuses[1], at_s


def test_a_seek_while_seeking_goes_to_the_last(theater: Callable) -> None:
    viewer = theater(recorded(), CONFIG)
    answers = [viewer.loop.enqueue(Seek(at_s)) for at_s in (5.0, 1.0, 3.0)]
    viewer.turn_until(lambda: all(answer.done() for answer in answers))
    assert viewer.playback.position_s == 3.0
    straight = theater(viewer.paths, CONFIG)
    straight.do(Seek(3.0))
    assert viewer.nodes() == straight.nodes()


def test_nothing_is_drawn_on_the_way(theater: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    viewer = theater(recorded(), CONFIG)
    viewer.do(Seek(5.0))
    monkeypatch.setattr(loop, "SEEKING_S", 0.0)  # each step is a turn
    seeking: list[bool] = []
    flush = viewer.scene.flush

    def noted() -> None:
        flush()
        seeking.append(viewer.loop.state().playback.is_seeking)

    monkeypatch.setattr(viewer.scene, "flush", noted)
    answer = viewer.loop.enqueue(Seek(2.0))
    turns = 0
    while not answer.done():
        viewer.turn()
        turns += 1
    assert turns > 3
    assert seeking == [False]
