"""`webviz demo --zenoh`: router, simulator and viewer in three processes without DDS."""

from __future__ import annotations

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

GOAL = "geometry_msgs/msg/PoseStamped"


@pytest.fixture(scope="module")
def source() -> Iterator[ZenohSource]:
    with zenoh_simulator([], Stop()) as endpoint:
        source = ZenohSource(zenoh_address(endpoint))
        until(lambda: "/scan" in source.offers())
        yield source
        source.close()


def test_no_process_of_it_has_dds(source: ZenohSource) -> None:
    children = [
        child for child in psutil.Process().children() if "webviz_sim.zenoh" in str(child.cmdline())
    ]
    assert len(children) == 2
    for child in children:
        maps = Path(f"/proc/{child.pid}/maps").read_text()
        assert "zenoh" in maps
        assert "librmw" not in maps
        assert "fastdds" not in maps


def test_the_robot_is_there(source: ZenohSource) -> None:
    wanted = {
        "/scan": "sensor_msgs/msg/LaserScan",
        "/map": "nav_msgs/msg/OccupancyGrid",
        "/tf": "tf2_msgs/msg/TFMessage",
        "/tf_static": "tf2_msgs/msg/TFMessage",
        "/robot_description": "std_msgs/msg/String",
    }
    source.want({topic: Subscription(type, Topic(topic)) for topic, type in wanted.items()})
    until(lambda: set(source.inbox.received()) == set(wanted))
    arrived = source.inbox.drain()
    scan = decode(wanted["/scan"], arrived["/scan"][-1].cdr)
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
