"""A cause is one finding: what follows from it is explained or left out."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import examining
import pytest
from examining import HERE, SCAN, look, three_ranges

from webviz.api.observation import Observation
from webviz.api.offer import Offer, Publisher
from webviz.shell.testing.harness import Harness
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import SECOND
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.odometry import Odometry
from webviz_displays.tf import TF
from webviz_sim.pose import Pose2D

WALL_NS = 1_700_000_000 * SECOND
CLOCK = "rosgraph_msgs/msg/Clock"
ODOMETRY = "nav_msgs/msg/Odometry"
TFS = "tf2_msgs/msg/TFMessage"
QOS = "reliable", "volatile"

Make = Callable[..., Harness]


def offer(stage: Harness, topic: str, type_name: str, *nodes: str) -> None:
    """Let nodes publish a topic."""
    publishers = tuple(Publisher(node, type_name, *QOS) for node in nodes)
    stage.source.topics[topic] = Offer(publishers, QOS)


def ids(stage: Harness, publish: Callable[[], object] = lambda: None, rounds: int = 4) -> set[str]:
    """The ids of all findings after some rounds, half a second apart."""
    for _ in range(rounds):
        stage.findings(0.5, publish)
    return {each.id for each in stage.viewer.snapshot().findings}


@pytest.mark.parametrize(("clocks", "id"), [(0, "TIME004"), (1, "TIME013"), (2, "TIME003")])
def test_simulated_data_is_not_blamed_beside_a_clock_that_stands_or_two(
    webviz_harness: Make, clocks: int, id: str
) -> None:
    stage = webviz_harness(LaserScan(), fixed_frame="map")
    stage.source.now = WALL_NS
    if clocks:
        offer(stage, "/clock", CLOCK, *("/gazebo", "/player")[:clocks])

    def publish() -> None:
        stage.publish("/scan", SCAN, three_ranges("map", stage.source.now - WALL_NS))
        if clocks > 1:
            sec = (stage.source.now - WALL_NS) // SECOND
            stage.publish("/clock", CLOCK, {"clock": {"sec": sec}})

    cause_ids = ids(stage, publish, 1)
    assert {each for each in cause_ids if each.startswith("TIME")} == {id}


@pytest.mark.parametrize("is_off", [False, True])
def test_stamps_of_data_are_not_blamed_beside_transforms_of_the_same_clock(
    webviz_harness: Make, is_off: bool
) -> None:
    stage = webviz_harness(LaserScan(), TF(), fixed_frame="map")
    stage.source.now = WALL_NS

    def publish() -> None:
        for _ in range(5):
            stage.source.now += SECOND // 20
            stamp_ns = stage.source.now - 60 * SECOND
            stage.transform("map", "odom", stamp_ns=stamp_ns if is_off else stage.source.now)
            stage.publish("/scan", SCAN, three_ranges("map", stamp_ns))
            stage.turn()

    cause_ids = ids(stage, publish, 1)
    assert ("TIME010" in cause_ids, "TIME009" in cause_ids) == (is_off, not is_off)


def test_odometry_is_not_compared_with_a_transform_of_two_publishers(webviz_harness: Make) -> None:
    stage = webviz_harness(Odometry(), fixed_frame="odom")
    offer(stage, "/tf", TFS, "/wheels", "/other")
    offer(stage, "/odom", ODOMETRY, "/wheels")
    place = {"position": {"x": 3.0}, "orientation": {"w": 1.0}}

    def publish(is_twice: bool) -> None:
        now = stage.source.now
        for x in (1.0, 9.0) if is_twice else (1.0,):
            stage.transform("odom", "base_link", (x, 0.0, 0.0), stamp_ns=now)
        values = {"header": header("odom", now), "child_frame_id": "base_link"}
        pose = {"pose": {"pose": place, "covariance": [0.1] * 36}}
        stage.publish("/odom", ODOMETRY, values | pose)

    assert "DATA021" in ids(stage, lambda: publish(False), 1)
    cause_ids = ids(stage, lambda: publish(True), 1)
    assert "DATA021" not in cause_ids
    assert "TF011" in cause_ids


@pytest.mark.parametrize("node", ["/wheels", "/filter"])
def test_silent_odometry_explains_the_transform_of_its_node(
    webviz_harness: Make, node: str
) -> None:
    stage = webviz_harness(Odometry(), LaserScan(), fixed_frame="map")
    offer(stage, "/odom", ODOMETRY, "/wheels")
    offer(stage, "/tf", TFS, node)
    stage.transform("map", "odom")
    stage.transform("base_link", "laser")

    def publish() -> None:
        stage.publish("/scan", SCAN, three_ranges("laser", stage.source.now))

    cause_ids = ids(stage, publish)
    assert "GRAPH008" in cause_ids
    assert ("TF005" in cause_ids) == (node != "/wheels")


def test_all_transforms_of_another_clock_are_one_finding(webviz_harness: Make) -> None:
    stage = webviz_harness(LaserScan(), Odometry(), fixed_frame="map")
    for stamp_ns in (50 * SECOND, 51 * SECOND):
        stage.transform("map", "base_link", stamp_ns=stamp_ns)
        stage.transform("map", "odom", stamp_ns=stamp_ns)

    def publish() -> None:
        now = stage.source.now + WALL_NS
        stage.publish("/scan", SCAN, three_ranges("base_link", now))
        values: dict[str, Any] = {"header": header("odom", now)}
        stage.publish("/odom", ODOMETRY, values)

    ids(stage, publish)
    findings = [each.id for each in stage.viewer.snapshot().findings]
    assert findings.count("TIME011") == 1


@pytest.mark.parametrize("is_twice", [False, True])
def test_two_publishers_of_a_frame_explain_a_scan_that_does_not_fit(
    webviz_harness: Make, is_twice: bool
) -> None:
    stage = webviz_harness(LaserScan(name="Scan"), Map(), fixed_frame="map")
    beside = Pose2D(HERE.x + 0.8, HERE.y + 0.5)

    def publish() -> None:
        look(stage, beside)
        for x in (HERE.x, HERE.x + 0.8) if is_twice else ():
            stage.transform("map", "laser", (x, HERE.y, 0.0), stamp_ns=stage.source.now)

    for _ in range(3):
        publish()
        stage.turn()
    findings = {*examining.examined(stage, examining.CauseLevel.DATA)}
    assert ("DATA003 Scan" in findings) != is_twice


@pytest.mark.parametrize(("frame", "is_found"), [("map", True), ("utm", False)])
def test_utm_coordinates_are_valid_in_the_utm_frame(
    webviz_harness: Make, frame: str, is_found: bool
) -> None:
    stage = webviz_harness(LaserScan(), fixed_frame=frame)
    stage.transform(frame, "base_link", (4.5e5, 5.4e6, 0.0))

    def publish() -> None:
        stage.publish("/scan", SCAN, three_ranges("base_link", stage.source.now))

    cause_ids = ids(stage, publish)
    assert ("TF022" in cause_ids) == is_found
    assert math.hypot(4.5e5, 5.4e6) > 1e5


@pytest.mark.parametrize("has_begun", [False, True])
def test_a_robot_that_ended_as_a_whole_has_left(
    webviz_harness: Make, monkeypatch: pytest.MonkeyPatch, has_begun: bool
) -> None:
    monkeypatch.setattr(Observation, "is_alone", lambda observation: True)
    monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)  # it would be the cause
    stage = webviz_harness(LaserScan(), Map(), fixed_frame="map")
    stage.source.now = WALL_NS
    if has_begun:
        offer(stage, "/scan", SCAN, "/lidar")
        stage.publish("/scan", SCAN, three_ranges("map", WALL_NS))
        stage.turn()
        stage.source.topics.clear()
    ids(stage)
    (empty,) = [each for each in stage.viewer.snapshot().findings if each.id == "GRAPH001"]
    text = "All other ROS nodes have left" if has_begun else "No other ROS node is visible in"
    assert empty.cause.startswith(f"{text} domain ")
