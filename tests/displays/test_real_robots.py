"""Real robots through the RobotModel display: what is drawn and what is said to be missing."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from inspecting import Benches
from robot_arm import is_loaded, wait
from robots import link_poses, robots_folder
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from webviz.data.messages import decode
from webviz.shell.testing import DisplayBench
from webviz_displays.robot_model import RobotModel
from webviz_urdf import load_file

BAG = Path(__file__).parents[3] / "shared/data/bags/macfirst_floor_take_2"


# tests/urdf reads all 69; the display must tell apart what these bring.
FILES = (
    "asr_twodof_description/urdf/TwoDofs.urdf",  # several visuals of a link
    "double_pendulum_description/urdf/double_pendulum_simple.urdf",  # no meshes
    "iris_description/robots/iris.urdf",  # COLLADA and STL
    "quadruped_description/urdf/quadruped.urdf",  # Wavefront
    "romeo_description/urdf/romeo_laas_small.urdf",  # meshes that are not there
    "simple_humanoid_description/urdf/simple_humanoid.urdf",  # no visuals
    "tiago_description/robots/tiago_dual.urdf",  # many links without visuals
    "ur_description/urdf/ur3.urdf",  # no links
)


def said_of_visuals(bench: DisplayBench) -> tuple[int, int]:
    """Return the number of visuals the display reports as loaded, and their total."""
    statuses = re.search(r"(\d+) of (\d+) visuals loaded", bench.statuses()["URDF"][1])
    assert statuses is not None
    loaded, total = map(int, statuses.groups())
    return loaded, total


def drawn_visuals(bench: DisplayBench) -> int:
    return sum(" visual " in key for key in bench.nodes())


@pytest.mark.parametrize("file", FILES)
def test_every_visual_of_a_robot_is_drawn_or_reported_as_missing(bench: Benches, file: str) -> None:
    path = robots_folder() / file
    declared = ElementTree.parse(path).getroot()
    at = bench(RobotModel(description_source="File", description_file=str(path)))
    if declared.find("link") is None:
        wait(at, lambda: is_loaded(at))
        assert "no <link>" in at.statuses()["URDF"][1]
        assert at.nodes() == {}
        return
    for link in declared.findall("link"):
        at.transform("map", link.attrib["name"])
    wait(at, lambda: is_loaded(at))
    loaded, total = said_of_visuals(at)
    assert drawn_visuals(at) == loaded
    assert total == len(declared.findall("link/visual"))
    assert ("Meshes" in at.statuses()) == (loaded < total)
    assert at.statuses()["Links"][0] == "OK"


def test_the_links_of_panda_stand_where_its_joints_put_them(bench: Benches) -> None:
    path = robots_folder() / "panda_description/urdf/panda.urdf"
    at = bench(RobotModel(description_source="File", description_file=str(path)))
    robot = load_file(path)
    at.transform("map", robot.root)
    for joint in robot.joints.values():
        w, x, y, z = joint.origin.wxyz
        at.transform(joint.parent, joint.child, joint.origin.position, (x, y, z, w))
    wait(at, lambda: is_loaded(at))
    poses = link_poses(robot)
    for key, pose in at.poses().items():
        link = key.partition(" visual ")[0]
        assert pose.position == pytest.approx(poses[link].position, abs=1e-6)


@pytest.mark.skipif(not BAG.exists(), reason="the bag of the TurtleBot 4 is not here")
def test_a_recorded_turtlebot_is_placed_by_its_own_transforms(bench: Benches) -> None:
    at = bench(RobotModel(), fixed_frame="odom")
    at.buffer.cache_time_ns = 10**12
    topics = ("/tf", "/tf_static", "/robot_description")
    descriptions = []
    with AnyReader([BAG], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        connections = [c for c in reader.connections if c.topic in topics]
        for connection, time_ns, data in reader.messages(connections):
            at.now_ns = time_ns
            if connection.topic == "/robot_description":
                descriptions.append(bytes(data))
                continue
            is_static = connection.topic == "/tf_static"
            for t in decode(connection.msgtype, bytes(data)).transforms:
                at.buffer.set_transform(
                    t.parent, t.child, t.stamp_ns, t.translation, t.rotation, is_static
                )
    at.send_bytes("std_msgs/msg/String", descriptions[0], "/robot_description")
    wait(at, lambda: is_loaded(at))
    statuses = at.statuses()
    loaded, total = said_of_visuals(at)
    assert drawn_visuals(at) == loaded
    assert statuses["Meshes"][0] == "ERROR"
    assert f"{total - loaded} shapes missing" in statuses["Meshes"][1]
    # No node of that robot publishes how far its wheels' suspensions are pressed in.
    level, text = statuses["Links"]
    assert level == "ERROR"
    expected = "2 of 38 links without a transform: wheel_drop_left, wheel_drop_right."
    assert text.startswith(expected)
    # One reason for both is said once, at the first of them.
    (key,) = (key for key in statuses if key.startswith("Link "))
    assert key == "Link wheel_drop_left"
    assert "the state of its joint 'wheel_drop_left_joint' is probably not" in statuses[key][1]
