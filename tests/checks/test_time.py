"""Faults of clocks and stamps."""

from __future__ import annotations

import math
from collections.abc import Callable

import examining
import pytest
from examining import SCAN, three_ranges

from webviz import Finding
from webviz.api.finding import CauseLevel
from webviz.api.offer import Offer, Publisher
from webviz.engine.commands import Reset
from webviz.shell.testing.harness import Harness
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import SECOND
from webviz_displays.laser_scan import LaserScan

WALL_NS = 1_700_000_000 * SECOND
SIMULATOR = Publisher("/simulator", "rosgraph_msgs/msg/Clock", "reliable", "volatile")
PLAYER = Publisher("/player", "rosgraph_msgs/msg/Clock", "reliable", "volatile")

Make = Callable[..., Harness]


@pytest.fixture
def stage(webviz_harness: Make) -> Harness:
    """A viewer on wall time."""
    stage = webviz_harness(LaserScan(), fixed_frame="map")
    stage.source.now = WALL_NS
    stage.turn()
    return stage


def examined(stage: Harness, seconds: float = 1.1) -> dict[str, Finding]:
    """The findings about time."""
    return examining.examined(stage, CauseLevel.TIME, seconds)


def scans(stage: Harness, stamp_ns: Callable[[int], int]) -> None:
    """Publish scans, stamped as a function of the time."""
    for _ in range(6):
        stage.source.now += SECOND // 4
        stage.clock += 0.25
        stage.publish("/scan", SCAN, three_ranges("map", stamp_ns(stage.source.now)))
        stage.turn()


@pytest.mark.parametrize(
    ("id", "stamp_ns"),
    [
        ("TIME004 /scan", lambda now: now - WALL_NS + SECOND),
        ("TIME006 /scan", lambda now: 0),
        ("TIME007 /scan", lambda now: WALL_NS),
        ("TIME008 /scan", lambda now: now + 5 * SECOND),
        ("TIME009 /scan", lambda now: now - 5 * SECOND),
        ("", lambda now: now - SECOND // 20),
    ],
)
def test_stamps(stage: Harness, id: str, stamp_ns: Callable[[int], int]) -> None:
    scans(stage, stamp_ns)
    assert [*examined(stage)] == ([id] if id else [])


def clocks(stage: Harness, *publishers: Publisher) -> None:
    """Let these nodes publish /clock."""
    stage.source.known["/clock"] = Offer(publishers, None)
    stage.source.clock_count = 10


def standing(stage: Harness, rounds: int, at_ns: int | None = None) -> dict[str, Finding]:
    """The findings after some rounds in which ROS time stands."""
    stage.viewer.doctor.slice_s = math.inf
    for _ in range(rounds):
        stage.source.now = stage.source.now if at_ns is None else at_ns
        stage.clock += 1.1
        stage.turn()
        stage.state()
    return examining.by_key(stage.state().findings, CauseLevel.TIME)


def test_a_clock_that_is_missing_ends_or_is_there_twice(stage: Harness) -> None:
    clocks(stage)
    assert standing(stage, 1, 0) == {}  # it takes two rounds
    assert [*standing(stage, 5, 0)] == ["TIME001"]
    clocks(stage, SIMULATOR, PLAYER)
    assert [*examined(stage)] == ["TIME003"]
    clocks(stage, SIMULATOR)
    assert examined(stage) == {}
    clocks(stage)
    assert [*standing(stage, 6)] == ["TIME002"]


def test_a_node_on_wall_time(stage: Harness) -> None:
    clocks(stage, SIMULATOR)
    stage.source.now = 100 * SECOND
    stage.turn()
    scans(stage, lambda now: WALL_NS + now)
    assert [*examined(stage)] == ["TIME005 /scan"]


def test_transforms_of_another_clock(stage: Harness) -> None:
    for _ in range(3):
        stage.source.now += SECOND // 4
        stage.transform("map", "odom", stamp_ns=stage.source.now - 60 * SECOND)
        stage.turn()
    found = examined(stage)
    assert [*found] == ["TIME010"]
    assert [each.status for each in found["TIME010"].explains] == ["Clocks"]


def test_data_and_transforms_of_two_clocks(stage: Harness) -> None:
    stage.transform("map", "base_link", stamp_ns=50 * SECOND)
    stage.transform("map", "base_link", stamp_ns=51 * SECOND)
    stage.publish("/scan", SCAN, {"header": header("base_link", stage.source.now)})
    stage.turn()
    assert "TIME011 base_link" in examined(stage)


def test_a_bag_that_started_again_beside_a_robot(stage: Harness) -> None:
    def publish(stamp_ns: int) -> None:
        stage.transform("map", "arm", stamp_ns=stage.source.now)
        stage.transform("map", "odom", stamp_ns=stamp_ns)
        stage.publish("/scan", SCAN, {"header": header("odom", stamp_ns)})

    for _ in range(5):
        stage.source.now += SECOND // 10
        publish(stage.source.now)
        stage.turn()
    found = examining.examined(
        stage, CauseLevel.TIME, 0.5, lambda: publish(stage.source.now - 60 * SECOND)
    )
    assert "TIME012 odom" in found
    stage.viewer.enqueue(Reset())
    assert "TIME012 odom" not in examining.examined(
        stage, CauseLevel.TIME, 0.5, lambda: publish(stage.source.now)
    )
