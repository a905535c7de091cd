"""Bags whose clocks jump, whose messages are out of order, or that have hardly any."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import pytest
from bags import START_NS, TF, Bag, Topic, files, ns, stamped, strings
from rosbags.rosbag2 import StoragePlugin

from webviz.commands import Play, Seek, StepMessage
from webviz.shell.testing import check_seeks, header

CONFIG = """\
fixed_frame: map
displays:
- {type: LaserScan, decay_time: 1.2}
- {type: Map}
- {type: TF}
"""
STORAGES = [StoragePlugin.MCAP, StoragePlugin.SQLITE3]


def drive(stamp_s: Callable[[float], float] = lambda at_s: at_s) -> Bag:
    """Six seconds of a robot with a latched map; `stamp_s` are stamps by times of recording."""
    bag = Bag()
    bag.add("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
    bag.add("/scan", "sensor_msgs/msg/LaserScan")
    bag.add("/tf", TF)
    info = {"resolution": 1.0, "width": 2, "height": 2, "origin": {"orientation": {"w": 1}}}
    for at_s in (0.0, 2.5):
        head = header("map", START_NS + ns(stamp_s(at_s)))
        bag.put(at_s, "/map", {"header": head, "info": info, "data": [round(10 * at_s)] * 4})
    for step in range(60):
        at_s = step / 10
        stamp_ns = START_NS + ns(stamp_s(at_s))
        ranges = {"angle_increment": 0.1, "range_max": 9.0, "ranges": [1.0 + at_s, 2.0]}
        bag.put(at_s, "/scan", {"header": header("base", stamp_ns), **ranges})
        bag.put(at_s + 0.03, "/tf", {"transforms": [stamped("map", "base", stamp_ns, at_s)]})
    return bag


def simulated(jump_s: float) -> Bag:
    """A drive whose /clock jumps in the middle."""

    def stamp_s(at_s: float) -> float:
        return 100.0 + at_s + (jump_s if at_s >= 3 else 0.0)

    bag = drive(stamp_s)
    bag.topics["/clock"] = Topic("rosgraph_msgs/msg/Clock")
    for step in range(600):
        at_s = step / 100
        sec, nanosec = divmod(START_NS + ns(stamp_s(at_s)), ns(1))
        bag.messages.insert(0, (at_s, "/clock", {"clock": {"sec": sec, "nanosec": nanosec}}))
    return bag


@pytest.mark.parametrize("jump_s", [-50.0, -2.0, 2.0, 5000.0])
def test_a_clock_that_jumps_within_a_bag(tmp_path: Path, jump_s: float) -> None:
    check_seeks(simulated(jump_s).write(tmp_path / "run"), CONFIG, times=[5.5, 2.9, 3.2, 1.0, 4.0])


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize("jump_s", [-2.0, 5000.0])
def test_a_clock_of_the_recorder_that_jumps(
    tmp_path: Path, jump_s: float, storage: StoragePlugin
) -> None:
    bag = drive()
    bag.messages = [(at_s + jump_s * (at_s >= 3), *rest) for at_s, *rest in bag.messages]  # pyright: ignore[reportAttributeAccessIssue]
    check_seeks(bag.write(tmp_path / "run", storage), CONFIG, count=5, seed=1)


@pytest.mark.parametrize("storage", STORAGES)
def test_messages_out_of_order_in_the_file(
    tmp_path: Path, storage: StoragePlugin, monkeypatch: pytest.MonkeyPatch
) -> None:
    chance = random.Random(1)
    monkeypatch.setattr("bags.sorted", lambda all, **_: chance.sample(all, len(all)), raising=False)
    path = drive().write(tmp_path / "run", storage)
    check_seeks(path, CONFIG, count=5, seed=2)


def test_files_of_a_folder_that_overlap_in_time_are_merged(
    tmp_path: Path, theater: Callable
) -> None:
    folder = strings(0, 2, 4, 5).write(tmp_path / "run")
    (first,) = files(folder, ".mcap")
    names = [first.name]
    for number, seconds in enumerate([(1, 3), (6, 7)], 1):
        (more,) = files(strings(*seconds).write(tmp_path / f"more{number}"), ".mcap")
        names.append(more.rename(folder / f"run_{number}.mcap").name)
    metadata = folder / "metadata.yaml"
    listed = "".join(f"- {name}\n  " for name in reversed(names)).rstrip(" ")
    metadata.write_text(metadata.read_text().replace(f"- {first.name}\n", listed))
    viewer = theater(folder)
    places = []
    for is_forward in [True] * 8 + [False] * 7:
        playback = viewer.do(StepMessage("/words", is_forward)).playback
        places.append(playback.position_s)
    assert places == [0, 1, 2, 3, 4, 5, 6, 7, 6, 5, 4, 3, 2, 1, 0]


@pytest.mark.parametrize("storage", STORAGES)
def test_a_bag_with_one_message(tmp_path: Path, theater: Callable, storage: StoragePlugin) -> None:
    viewer = theater(drive_of_one().write(tmp_path / "run", storage), "displays: [{type: Map}]")
    assert viewer.do(Play()).playback.position_s == 0.0
    viewer.turn_until(lambda: not viewer.playback.is_playing)
    viewer.do(Seek(0.0))
    assert viewer.playback.position_s == 0.0
    assert [*viewer.scene.visible()]
    viewer.turn_until(lambda: bool(viewer.loop.state().recorded))
    counts = viewer.loop.state().recorded["/map"]
    assert (counts[0], sum(counts)) == (1, 1)
    assert "Bag" not in viewer.loop.state().statuses


def drive_of_one() -> Bag:
    bag = drive()
    bag.messages = bag.messages[:1]
    return bag
