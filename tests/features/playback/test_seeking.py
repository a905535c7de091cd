"""Seeks: the scene equals that of a straight play to the same time, node by node."""

from __future__ import annotations

import contextlib
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Annotated, Any

import msgspec
import pytest
from bags import START_NS, Bag, ns, strings
from drives import CONFIG, recorded
from rosbags.rosbag2 import StoragePlugin

from tests.support.panel_facts import show as show_panel
from webviz import Context, Display, Input, Lookback, Sample, Topic
from webviz.api.display import inputs
from webviz.commands import OpenPanels, Play, Seek, SelectSpan, SetRate, StepMessage
from webviz.engine.loop import loop
from webviz.files.config import Config
from webviz.page.recorded_ui import RecordedUi
from webviz.shell.app.bag_config import config_of
from webviz.shell.testing import BagViewer, check_seeks, header
from webviz.shell.testing.seeking import plain
from webviz.sources.bag.file import Recorded
from webviz.sources.bag.history import BagHistory


@pytest.mark.parametrize(
    ("storage", "seed"),
    [(StoragePlugin.MCAP, 1), (StoragePlugin.MCAP, 2), (StoragePlugin.SQLITE3, 3)],
)
def test_seeking_equals_playing(tmp_path: Path, storage: StoragePlugin, seed: int) -> None:
    path = recorded(seed).write(tmp_path / "run", storage)
    check_seeks(path, CONFIG, count=8, seed=seed)


def test_a_seek_in_a_long_bag_reads_little(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = recorded(4, duration_s=90, step_s=0.3).write(tmp_path / "run")
    check_seeks(path, CONFIG, times=[80.0, 40.0, 89.5, 3.0, 60.0])
    viewer = BagViewer(path, "displays: [{type: TF}, {type: LaserScan}, {type: Map}]")
    read: list[int] = []
    messages = BagHistory.messages

    def counting(*args: Any) -> Iterator[Recorded]:
        for each in messages(*args):
            read.append(each.stamp_ns)
            yield each

    monkeypatch.setattr(BagHistory, "messages", counting)
    viewer.do(Seek(80.0))
    viewer.close()
    # Of 600: transforms of 15 s, which are found first and then played, scans, and the map.
    assert len(read) < 230


def test_a_display_of_a_plug_in_that_declares_too_little_is_found(tmp_path: Path) -> None:
    config = Config(displays=[OdometrySum(name="Sum", topic=Topic("/odom"))])
    config.set_fixed_frame("odom")
    path = recorded().write_file(tmp_path / "run.mcap")
    check_seeks(path, config, times=[4.0])
    config.displays[0].is_wrong = True  # pyright: ignore[reportAttributeAccessIssue]
    with pytest.raises(AssertionError, match=r"Sum differs at 4 s after a seek from 0 s"):
        check_seeks(path, config, times=[4.0])


class OdometrySum(Display):
    """The sum of all that was received."""

    topic: Annotated[Topic, Input("nav_msgs/msg/Odometry")] = Topic("/odom")
    is_wrong: bool = False

    def fold(self, name: str, sample: Sample, state: float | None) -> float:
        return (state or 0.0) + sample.message.pose.pose.position.x

    def lookback(self, name: str) -> Lookback:
        return Lookback(count=1) if self.is_wrong else Lookback()

    def draw(self, sample: Sample, ctx: Context) -> None:
        ctx.points("sum", [[sample.message, 0, 0]], (0, 0, 0), 0.1)


def describe(bag: Bag) -> None:
    """Add a robot with an arm, whose shape is a sphere, on its base."""
    urdf = (
        "<robot name='r'><link name='base'/><link name='arm'><visual><geometry>"
        "<sphere radius='0.1'/></geometry></visual></link><joint name='j' type='floating'>"
        "<parent link='base'/><child link='arm'/></joint></robot>"
    )
    bag.add("/robot_description", "std_msgs/msg/String", latched=True)
    bag.put(0, "/robot_description", {"data": urdf})


def test_links_are_not_where_they_will_be(tmp_path: Path) -> None:
    """A robot keeps links without transforms at their last pose, which may not be a later one."""
    bag = strings(0, 4)
    describe(bag)
    for at_s in (0.1, 2.0, 2.5):
        bag.transform(at_s, "map", "base")
    for at_s in (2.0, 2.5):
        bag.transform(at_s, "base", "arm")
    config = "fixed_frame: map\ndisplays: [{type: RobotModel}]\n"
    check_seeks(bag.write_file(tmp_path / "run.mcap"), config, times=[3.0, 1.0, 3.0])


def test_links_whose_transforms_ended_long_before_stay_in_grey(tmp_path: Path) -> None:
    bag = strings(0, 40)
    describe(bag)
    for step in range(80):
        bag.transform(step / 2, "map", "base", x=step / 2)
    for step in range(9):  # between two transforms of the base
        bag.transform(step / 2 + 0.2, "base", "arm", x=1.0)
    config = "fixed_frame: map\ndisplays: [{type: RobotModel}]\n"
    path = bag.write_file(tmp_path / "run.mcap")
    check_seeks(path, config, times=[35.0, 3.0, 20.0, 39.0, 30.0])
    with contextlib.closing(BagViewer(path, config)) as viewer:
        viewer.do(Seek(35.0))
        (nodes,) = viewer.visible_nodes().values()
        assert nodes


def test_frames_whose_transforms_ended_long_before_are_known(tmp_path: Path) -> None:
    bag = Bag()
    for at_s in (0.5, 30.0, 31.0):
        bag.transform(at_s, "map", "odom")
    for second in range(60):
        bag.transform(second + 0.1, "odom", "base")
    config = "fixed_frame: map\ndisplays: [{type: Axes, reference_frame: odom}, {type: TF}]\n"
    check_seeks(
        bag.write_file(tmp_path / "run.mcap"), config, times=[20.0, 59.0, 3.0, 29.0, 50.0, 17.0]
    )


def test_stepping_equals_playing_in_both_directions(tmp_path: Path) -> None:
    path = recorded(5).write_file(tmp_path / "run.mcap")
    chance = random.Random(5)
    stepped, played = BagViewer(path, CONFIG), BagViewer(path, CONFIG)
    stepped.do(Seek(4.0))
    result: dict[float, Any] = {}
    for _ in range(10):
        topic = chance.choice(["", "/odom", "/scan"])
        stepped.do(StepMessage(topic, is_forward=chance.random() < 0.4))
        result[(stepped.source.reached_ns - stepped.source.history.start_ns) / 1e9] = plain(
            stepped.visible_nodes()
        )
    assert len(result) > 4
    for at_s, drawing in sorted(result.items()):
        played.play_to(at_s)
        assert drawing == plain(played.visible_nodes()), at_s
    stepped.close()
    played.close()


BAGS = Path(__file__).parents[4] / "shared/data/bags"
REAL = ["nav2_turtlebot.mcap", "husky_filtered_bag", "macfirst_floor_take_2", "thesis_cart"]


@pytest.mark.parametrize("name", REAL)
def test_seeking_equals_playing_in_a_real_bag(name: str) -> None:
    if not (BAGS / name).exists():
        pytest.skip("the recorded bags are not on this machine")
    with contextlib.closing(BagHistory(BAGS / name)) as bag:
        config = config_of(bag)
    for display in config.displays:  # their transforms come late
        for path, _, topic in inputs(display):  # pyright: ignore[reportArgumentType]
            setattr(display, path, msgspec.structs.replace(topic, filter_size=100))
    check_seeks(BAGS / name, config, count=5, seed=3)


def test_a_plot_shows_its_window_after_a_seek(theater: Callable) -> None:
    config = "panels: [{type: Plot, curves: [/odom.pose.pose.position.x], window: 2.0}]\n"

    def plotted(viewer: Any) -> list[tuple[float, float]]:
        (tab,) = viewer.loop.state().panels
        show_panel(tab.panel, viewer.loop.state())
        (series,) = tab.panel.series.values()
        newest_s, _ = series.history.newest
        return [point for point in series.history.points() if point[0] > newest_s - 2.0]

    def open_seeking() -> Any:
        viewer = theater(bag, config)
        (tab,) = viewer.loop.state().panels
        tab.panel.build(RecordedUi(), lambda *_: None)
        show_panel(tab.panel, viewer.loop.state())
        viewer.do(OpenPanels(frozenset({tab.tab})))
        return viewer

    bag = recorded(duration_s=8.0)
    played, sought = open_seeking(), open_seeking()
    played.do(SetRate(0.0))
    played.do(Seek(0.0))
    played.do(SelectSpan(0.0, 5.0))
    played.do(Play())
    played.turn_until(lambda: not played.loop.state().playback.is_playing)
    sought.do(Seek(5.0))
    assert len(plotted(sought)) == 20
    assert plotted(sought) == plotted(played)


def test_seeking_before_the_first_transform_clears_later_statuses(
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
    bag = recorded()
    viewer, straight = theater(bag, CONFIG), theater(bag, CONFIG)
    answers = [viewer.loop.enqueue(Seek(at_s)) for at_s in (5.0, 1.0, 3.0)]
    viewer.turn_until(lambda: all(answer.done() for answer in answers))
    assert viewer.playback.position_s == 3.0
    straight.do(Seek(3.0))
    assert plain(list(viewer.visible_nodes().values())) == plain(
        list(straight.visible_nodes().values())
    )


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
