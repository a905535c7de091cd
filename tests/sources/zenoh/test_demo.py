"""`webviz demo --zenoh`: router, simulator and viewer in three processes without DDS."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest
from waiting import until

from webviz.api.declared import Topic
from webviz.data.messages import decode, encode
from webviz.shell.cli.demo import zenoh_simulator
from webviz.shell.cli.ending import Stop
from webviz.sources import Advertisement, Subscription
from webviz.sources.zenoh.address import zenoh_address
from webviz.sources.zenoh.source import ZenohSource

BASE = "base_link"
GOAL = "geometry_msgs/msg/PoseStamped"


@pytest.fixture(scope="module")
def source() -> Iterator[ZenohSource]:
    with zenoh_simulator([], Stop()) as endpoint:
        source = ZenohSource(zenoh_address(endpoint))
        until(lambda: "/scan" in source.offers())
        yield source
        source.close()


def test_no_process_of_it_has_dds(source: ZenohSource) -> None:
    alive = (c for c in psutil.Process().children() if c.status() != psutil.STATUS_ZOMBIE)
    children = [child for child in alive if "webviz_sim.zenoh" in str(child.cmdline())]
    assert len(children) == 2
    for child in children:
        maps = Path(f"/proc/{child.pid}/maps").read_text()
        assert "zenoh" in maps
        assert "librmw" not in maps
        assert "fastdds" not in maps


def test_the_robot_is_there(source: ZenohSource) -> None:
    expected = {
        "/scan": "sensor_msgs/msg/LaserScan",
        "/map": "nav_msgs/msg/OccupancyGrid",
        "/tf": "tf2_msgs/msg/TFMessage",
        "/tf_static": "tf2_msgs/msg/TFMessage",
        "/robot_description": "std_msgs/msg/String",
    }
    source.want({topic: Subscription(type, Topic(topic)) for topic, type in expected.items()})
    until(lambda: {t for t, (count, _) in source.inbox.received().items() if count} == {*expected})
    arrived = source.inbox.drain()
    scan = decode(expected["/scan"], arrived["/scan"][-1].cdr)
    assert len(scan.ranges) == 360
    assert source.offers()["/scan"].publishers[0].node == "/sim"
    assert source.offers()["/scan"].publishers[0].reliability == "best_effort"


def test_it_goes_where_it_is_sent(source: ZenohSource) -> None:
    type = "nav_msgs/msg/Path"
    source.want({"/path": Subscription(type, Topic("/path"))})
    goal = Advertisement("/goal_pose", GOAL)
    source.graph.advertise([goal]).result(5)
    values = {"header": {"frame_id": "map"}, "pose": {"position": {"x": -5.0, "y": 1.0}}}
    assert source.graph.publish(goal, encode(GOAL, values)).result(5) == 1

    def leads_there() -> bool:
        paths = source.inbox.drain().get("/path", ())
        ends = [decode(type, raw.cdr).poses[-1].pose.position for raw in paths]
        return any(abs(end.x + 5.0) < 0.3 and abs(end.y - 1.0) < 0.3 for end in ends)

    until(leads_there)


def test_it_drives_as_it_is_steered(source: ZenohSource) -> None:
    odometry, twist = "nav_msgs/msg/Odometry", "geometry_msgs/msg/Twist"
    source.want({"/odom": Subscription(odometry, Topic("/odom"))})
    wheel = Advertisement("/cmd_vel", twist)
    source.graph.advertise([wheel]).result(5)
    until(lambda: source.inbox.drain().get("/odom"))
    turning = encode(twist, {"angular": {"z": 0.8}})

    def turns() -> bool:
        assert source.graph.publish(wheel, turning).result(5) == 1
        arrived = source.inbox.drain().get("/odom", ())
        speeds = [decode(odometry, raw.cdr).twist.twist for raw in arrived]
        return any(abs(each.angular.z - 0.8) < 0.1 and each.linear.x < 0.05 for each in speeds)

    until(turns)


def test_it_is_placed_by_an_estimate_of_its_pose(source: ZenohSource) -> None:
    type, tf = "geometry_msgs/msg/PoseWithCovarianceStamped", "tf2_msgs/msg/TFMessage"
    source.want({"/tf": Subscription(tf, Topic("/tf"))})
    estimate = Advertisement("/initialpose", type)
    source.graph.advertise([estimate]).result(5)
    pose = {"position": {"x": -5.0, "y": 1.0}, "orientation": {"w": 1.0}}
    values = {"header": {"frame_id": "map"}, "pose": {"pose": pose}}
    assert source.graph.publish(estimate, encode(type, values)).result(5) == 1
    places: dict[str, tuple[float, float, float]] = {}

    def is_there() -> bool:
        for raw in source.inbox.drain().get("/tf", ()):
            for each in decode(tf, raw.cdr).transforms:
                x, y, _ = each.translation
                *_, z, w = each.rotation
                places[each.child] = x, y, 2 * math.atan2(z, w)
        if not {"odom", BASE} <= places.keys():
            return False
        (x, y, yaw), (ahead, left, _) = places["odom"], places[BASE]
        x += ahead * math.cos(yaw) - left * math.sin(yaw)
        y += ahead * math.sin(yaw) + left * math.cos(yaw)
        return math.hypot(x + 5.0, y - 1.0) < 0.5

    until(is_there)
