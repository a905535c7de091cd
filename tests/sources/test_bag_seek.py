"""A bag that ran to a moment unseen shows what one sees who watched from the start."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from bags import START_NS, Bag, ns
from drives import CELLS, grid

from webviz.engine.loop import FrameLoop
from webviz.files.opening import parse
from webviz.shell.testing import header
from webviz.shell.testing.recording import RecordingScene
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

CONFIG = """\
fixed_frame: map
displays:
- {type: LaserScan, decay_time: 1.2}
- {type: LaserScan, topic: /slow}
- {type: Odometry, keep: 7, position_tolerance: 0.25}
- {type: Map}
- {type: Axes, reference_frame: base}
"""


@pytest.fixture
def run(tmp_path: Path) -> Path:
    bag = Bag()
    bag.add("/scan", "sensor_msgs/msg/LaserScan", best_effort=True)
    bag.add("/slow", "sensor_msgs/msg/LaserScan", best_effort=True)
    bag.add("/odom", "nav_msgs/msg/Odometry")
    bag.add("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
    bag.add("/map_updates", "map_msgs/msg/OccupancyGridUpdate")
    bag.transform(0, "map", "odom", static=True)
    bag.put(0, "/map", grid(0))
    for step in range(60):
        at_s = step / 10
        stamp_ns = START_NS + ns(at_s)
        # The transform comes after the data that needs it, as it does on robots.
        ranges = {"angle_increment": 0.1, "range_max": 9.0, "ranges": [1.0 + at_s, 2.0, 3.0]}
        bag.put(at_s, "/scan", {"header": header("base", stamp_ns), **ranges})
        bag.put(
            at_s, "/slow", {"header": header("base", stamp_ns), "time_increment": 0.06, **ranges}
        )
        pose = {"pose": {"position": {"x": at_s}, "orientation": {"w": 1.0}}}
        bag.put(at_s + 0.01, "/odom", {"header": header("odom", stamp_ns), "pose": pose})
        bag.transform(at_s + 0.03, "odom", "base", x=at_s)
        if step % 10 == 5:
            x = step // 10 % CELLS
            update = {"x": x, "y": 1, "width": 1, "height": 1, "data": [100]}
            bag.put(at_s, "/map_updates", {"header": header("map", stamp_ns), **update})
    return bag.write_file(tmp_path / "run.mcap")


def show(run: Path, to_s: float, watched: bool) -> tuple[list[Any], list[Any]]:
    """Poses and nodes, and the rows of the panel in the end, of a bag that is played."""
    source, scene = Player(BagHistory(run)), RecordingScene()
    config = parse(CONFIG, "the config")
    viewer = FrameLoop(config, source, scene, strict=True, clock=lambda: source.reached_ns / 1e9)
    scene.watched = watched
    viewer.turn()
    until_ns = source.history.start_ns + ns(to_s)
    while source.reached_ns < until_ns:
        if watched:
            source.play_until(min(source.reached_ns + ns(0.01), until_ns))
        else:
            source.play_step(until_ns)
        viewer.turn()
    scene.watched = True
    viewer.turn()
    rows = viewer.state().rows
    viewer.close()
    source.close()
    # In which slot of a display a sample is drawn makes no difference.
    observed = sorted(((pose, node) for _, pose, node in scene.visible()), key=repr)
    return observed, list(rows)


@pytest.mark.parametrize("to_s", [0.0, 1.0, 2.0, 3.05, 5.9])
def test_playing_unseen_ends_where_watching_does(run: Path, to_s: float) -> None:
    watched, watched_rows = show(run, to_s, True)
    unseen, unseen_rows = show(run, to_s, False)
    assert watched
    assert unseen == watched
    levels = [[(row.name, row.level) for row in rows] for rows in (unseen_rows, watched_rows)]
    assert levels[0] == levels[1]


def test_history_is_longer_than_the_last_message(run: Path) -> None:
    nodes, _ = show(run, 5.9, False)
    assert len(nodes) > 10
