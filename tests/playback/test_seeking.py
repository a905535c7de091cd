"""After a seek the scene equals that of a straight play to the same time, node by node."""

from __future__ import annotations

import contextlib
import random
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import msgspec
import pytest
from bags import START_NS, Bag, ns, strings
from rosbags.rosbag2 import StoragePlugin

from webviz import Context, Display, Input, Lookback, Sample, Topic
from webviz.api.display import inputs
from webviz.engine.commands import Seek
from webviz.engine.loop import loop
from webviz.files.config import Config
from webviz.shell.app.bag_config import config_of
from webviz.shell.testing import BagViewer, check_seeks, header
from webviz.sources.bag.file import Recorded
from webviz.sources.bag.source import BagSource
from webviz_displays.odometry.display import Odometry

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


def recorded(seed: int = 7, duration_s: float = 6.0, step_s: float = 0.1) -> Bag:
    """A robot that drives; what it publishes when varies by chance."""
    chance = random.Random(seed)
    bag = Bag()
    bag.add("/scan", "sensor_msgs/msg/LaserScan", best_effort=True)
    bag.add("/odom", "nav_msgs/msg/Odometry")
    bag.add("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
    bag.add("/map_updates", "map_msgs/msg/OccupancyGridUpdate")
    bag.add("/path", "nav_msgs/msg/Path", latched=True, depth=2)
    bag.add("/markers", "visualization_msgs/msg/MarkerArray")
    bag.transform(0, "map", "odom", static=True)
    bag.transform(chance.uniform(0, duration_s), "base", "late", static=True)
    bag.put(0, "/map", grid(0))
    bag.put(chance.uniform(0, duration_s), "/map", grid(50))
    silent_s = chance.uniform(0, duration_s)
    for step in range(round(duration_s / step_s)):
        at_s = step * step_s
        stamp_ns = START_NS + ns(at_s)
        # The transform comes after the data that needs it, as it does on robots.
        ranges = {"angle_increment": 0.1, "range_max": 9.0, "ranges": [1.0 + at_s % 5, 2.0, 3.0]}
        if not silent_s < at_s < silent_s + duration_s / 4:
            bag.put(at_s, "/scan", {"header": header("base", stamp_ns), **ranges})
        pose = {"pose": {"position": {"x": at_s}, "orientation": {"w": 1.0}}}
        bag.put(at_s + 0.01, "/odom", {"header": header("odom", stamp_ns), "pose": pose})
        bag.transform(at_s + 0.03, "odom", "base", x=at_s)
        if chance.random() < 0.8:
            bag.put(at_s + 0.05, "/markers", markers(at_s, step))
        if chance.random() < 0.2:
            x = chance.randrange(CELLS)
            update = {"x": x, "y": 1, "width": 1, "height": 1, "data": [chance.randrange(100)]}
            bag.put(at_s, "/map_updates", {"header": header("map", stamp_ns), **update})
            place = {"header": header("map", stamp_ns), **pose}
            bag.put(at_s, "/path", {"header": header("map", stamp_ns), "poses": [place, place]})
    return bag


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_seek_shows_what_playing_shows(tmp_path: Path, storage: StoragePlugin, seed: int) -> None:
    path = recorded(seed).write(tmp_path / "run", storage)
    check_seeks(path, CONFIG, count=8, seed=seed)


def test_a_seek_in_a_long_bag_reads_little(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = recorded(4, duration_s=90, step_s=0.3).write(tmp_path / "run")
    check_seeks(path, CONFIG, times=[80.0, 40.0, 89.5, 3.0, 60.0])
    viewer = BagViewer(path, "displays: [{type: TF}, {type: LaserScan}, {type: Map}]")
    read: list[int] = []
    arrive = BagSource._arrive

    def counting(source: BagSource, recorded: Recorded) -> None:
        read.append(recorded.stamp_ns)
        arrive(source, recorded)

    monkeypatch.setattr(BagSource, "_arrive", counting)
    viewer.do(Seek(80.0))
    viewer.close()
    assert len(read) < 150  # of 600: transforms of 15 s, the newest scans, and the map


def test_a_display_of_a_plug_in_that_declares_too_little_is_found(tmp_path: Path) -> None:
    config = Config(displays=[Total(name="Sum", topic=Topic("/odom"))])
    config.set_fixed_frame("odom")
    path = recorded().write(tmp_path / "run")
    check_seeks(path, config, times=[4.0])
    config.displays[0].is_wrong = True  # pyright: ignore[reportAttributeAccessIssue]
    with pytest.raises(AssertionError, match=r"Sum differs at 4 s after a seek from 0 s"):
        check_seeks(path, config, times=[4.0])


class Total(Display):
    """The sum of all that was received."""

    topic: Annotated[Topic, Input("nav_msgs/msg/Odometry")] = Topic("/odom")
    is_wrong: bool = False

    def fold(self, name: str, sample: Sample, state: float | None) -> float:
        return (state or 0.0) + sample.message.pose.pose.position.x

    def lookback(self, name: str) -> Lookback:
        return Lookback(count=1) if self.is_wrong else Lookback()

    def draw(self, sample: Sample, ctx: Context) -> None:
        ctx.points("sum", [[sample.message, 0, 0]], (0, 0, 0), 0.1)


BAGS = Path(__file__).parents[3] / "shared/data/bags"
REAL = ["nav2_turtlebot.mcap", "husky_filtered_bag", "macfirst_floor_take_2", "thesis_cart"]


@pytest.mark.parametrize("name", REAL)
def test_a_seek_in_a_real_bag_shows_what_playing_shows(name: str) -> None:
    if not (BAGS / name).exists():
        pytest.skip("the recorded bags are not on this machine")
    with contextlib.closing(BagSource(BAGS / name)) as source:
        config = config_of(source)
    for display in config.displays:  # their transforms come late
        for path, _, topic in inputs(display):  # pyright: ignore[reportArgumentType]
            setattr(display, path, msgspec.structs.replace(topic, filter_size=100))
        if isinstance(display, Odometry):  # its trail begins anew after a seek
            display.position_tolerance = display.angle_tolerance = 0.0
    check_seeks(BAGS / name, config, count=5, seed=3)


def test_before_the_first_transform_no_status_is_left_of_what_was_drawn_later(
    theater: Callable,
) -> None:
    bag = strings(0, 4)
    bag.add("/scan", "sensor_msgs/msg/LaserScan")
    scan = {"angle_increment": 0.1, "range_max": 9.0, "ranges": [1.0, 2.0]}
    for at_s in (0.5, 2.5):
        bag.put(at_s, "/scan", {"header": header("base", START_NS + ns(at_s)), **scan})
    bag.put(3, "/scan", b"\x00\x01\x00\x00")
    for at_s in (2, 2.6):
        bag.transform(at_s, "map", "base")
    viewer = theater(bag, "fixed_frame: map\ndisplays: [{type: LaserScan}]\n")

    def levels(at_s: float) -> dict[str, str]:
        (row,) = viewer.do(Seek(at_s)).rows
        return {key: status.level.name for key, status in row.statuses.items()}

    before = levels(1.0)
    assert before["Transform"] == "WARN"
    assert levels(2.9)["Transform"] == "OK"
    assert levels(3.5)["Message"] == "ERROR"
    assert levels(1.0) == before


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
