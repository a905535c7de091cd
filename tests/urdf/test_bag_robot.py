"""A description as it came over a topic, from a bag of a real TurtleBot 4."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from robots import link_poses
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from webviz_urdf import Resolver, load_robot

BAG = Path(__file__).parents[3] / "shared/data/bags/macfirst_floor_take_2"


@pytest.mark.skipif(not BAG.exists(), reason="the bag of the TurtleBot 4 is not here")
def test_a_robot_whose_meshes_are_elsewhere_loads_and_lists_them() -> None:
    with AnyReader([BAG], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        connections = [c for c in reader.connections if c.topic == "/robot_description"]
        connection, _, data = next(reader.messages(connections))
        message: Any = reader.deserialize(data, connection.msgtype)
    text = message.data
    robot = load_robot(text, Resolver(ament_prefix_path=""))
    assert len(robot.links) == 38
    visuals = [shape for link in robot.links.values() for shape in link.visuals]
    missing = [m for m in robot.missing if m.kind == "visual"]
    assert len(visuals) + len(missing) == len(ElementTree.fromstring(text).findall("link/visual"))
    assert {m.uri.split("/")[2] for m in missing} == {
        "irobot_create_description",
        "turtlebot4_description",
    }
    assert all("neither on AMENT_PREFIX_PATH" in m.reason for m in missing)
    assert link_poses(robot).keys() == robot.links.keys()
