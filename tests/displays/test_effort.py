"""Effort: rings about the axes of joints."""

from __future__ import annotations

import tracemalloc
from collections.abc import Mapping
from typing import ClassVar

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from plain_scenes import torques

from webviz import Pose
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.vectors import Effort
from webviz_displays.vectors.effort import Rings
from webviz_urdf import RobotDescriptionError, turning_joints

NAN = float("nan")
SECOND = 1_000_000_000

ARM = """
<robot name="arm"><link name="base"/><link name="upper"/><link name="lower"/><link name="slider"/>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
<axis xyz="0 0 2"/><limit effort="10" velocity="1"/></joint>
<joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/>
<axis xyz="0 1 1"/></joint>
<joint name="slide" type="prismatic"><parent link="lower"/><child link="slider"/>
<limit effort="5" velocity="1"/></joint></robot>
"""


@pytest.fixture
def arm(bench: Benches) -> Benches:
    """A bench that knows the arm, and where its links are now."""

    def make(display: Effort, prefix: str = "") -> DisplayBench:
        at = bench(display)
        at.send("std_msgs/msg/String", {"data": ARM}, topic="/robot_description")
        at.turn()
        at.settle()
        for number, link in enumerate(("upper", "lower", "slider")):
            stamp_ns = at.now_ns
            at.transform("map", f"{prefix}{link}", (float(number), 0.0, 0.0), stamp_ns=stamp_ns)
        return at

    return make


def measure(at: DisplayBench, efforts: Mapping[str, float]) -> None:
    values = {"name": list(efforts), "effort": list(efforts.values())}
    at.send("sensor_msgs/msg/JointState", values, frame="", topic="/joint_states")
    at.turn()


@pytest.mark.parametrize(
    ("effort", "radius", "color"),
    [
        (5.0, 0.325, (0, 255, 64)),
        (-2.0, 0.175, (0, 64, 255)),
        (10.0, 0.575, (255, 0, 0)),
        (70.0, 0.575, (255, 0, 0)),
        (0.0, 0.075, (191, 0, 255)),
    ],
)
def test_a_ring_is_larger_and_redder_the_larger_the_effort(
    arm: Benches, effort: float, radius: float, color: tuple[int, ...]
) -> None:
    at = arm(Effort())
    measure(at, {"shoulder": effort})
    node, ring = at.nodes()["rings"], at.xyz("rings")
    np.testing.assert_allclose(np.linalg.norm(ring, axis=2), radius, atol=1e-6)
    np.testing.assert_allclose(ring[:, :, 2], 0.0, atol=1e-6)
    assert np.abs(node.colors[0, 0].astype(int) - color).max() <= 1
    # The ring turns towards its head, which is at its first point, as the torque does.
    around = np.cross(ring[0, 1], ring[0, 0])[2]
    assert (around > 0) == (effort >= 0)
    assert at.statuses()["Joint shoulder"] == ("OK", f"{effort:g} Nm of 10 Nm")


def test_a_ring_lies_in_the_plane_in_which_its_joint_turns(arm: Benches) -> None:
    at = arm(Effort())
    measure(at, {"elbow": 0.5})
    ring = at.xyz("rings") - (1, 0, 0)
    np.testing.assert_allclose(ring @ (0, 1, 1), 0.0, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(ring, axis=2), 0.05 + 0.55 / 2, atol=1e-6)
    assert "without a largest effort" in at.statuses()["Joint elbow"][1]


def test_a_message_waits_for_its_transforms_and_the_former_rings_stay(arm: Benches) -> None:
    at = arm(Effort())
    measure(at, {"shoulder": 5.0})
    at.turn(0.5)
    measure(at, {"shoulder": 10.0})
    np.testing.assert_allclose(np.linalg.norm(at.xyz("rings"), axis=2), 0.325, atol=1e-6)
    at.transform("map", "upper", (0.0, 0.0, 3.0), stamp_ns=at.now_ns)
    at.turn()
    np.testing.assert_allclose(at.xyz("rings")[:, :, 2], 3.0, atol=1e-6)
    assert at.statuses()["Joint shoulder"][1].startswith("10 Nm")


def test_previous_rings_are_kept_up_to_the_history_length(arm: Benches) -> None:
    at = arm(Effort(history_length=2))
    for effort in (1.0, 2.0, 3.0):
        measure(at, {"shoulder": effort})
    radii = np.linalg.norm(at.xyz("rings")[:, 0], axis=1).round(6)
    assert set(radii) == {0.175, 0.225}


def test_a_link_that_has_no_transform_does_not_hold_up_the_others(bench: Benches) -> None:
    at = bench(Effort())
    at.send("std_msgs/msg/String", {"data": ARM}, topic="/robot_description")
    at.turn()
    at.settle()
    at.transform("map", "upper", stamp_ns=at.now_ns)
    measure(at, {"shoulder": 5.0, "elbow": 1.0})
    assert set(at.nodes()["rings"].ids) == {"shoulder"}
    assert at.statuses()["Efforts"] == ("WARN", "Links have no transform: elbow.")


def test_a_prefix_is_that_of_the_frames(arm: Benches) -> None:
    at = arm(Effort(tf_prefix="/left/"), prefix="left/")
    measure(at, {"shoulder": 5.0})
    assert "rings" in at.nodes()


@pytest.mark.parametrize(
    ("efforts", "level", "text"),
    [
        ({"shoulder": NAN, "elbow": 1.0}, "WARN", "Efforts are not finite or above 1e6 Nm: shoul"),
        ({"slide": 1.0}, "WARN", "No joint of the message turns"),
        ({"hip": 1.0}, "WARN", "No joint of the message turns"),
    ],
)
def test_skipped_efforts_are_reported(
    arm: Benches, efforts: Mapping[str, float], level: str, text: str
) -> None:
    at = arm(Effort())
    measure(at, efforts)
    statuses = at.statuses()["Efforts"]
    assert (statuses[0], statuses[1].startswith(text)) == (level, True)


def test_joints_can_be_switched_off(arm: Benches) -> None:
    at = arm(Effort())
    measure(at, {"shoulder": 1.0, "elbow": 2.0})
    both = len(at.nodes()["rings"].segments)
    at.set("joints", {"elbow": False})
    assert 2 * len(at.nodes()["rings"].segments) == both
    assert at.statuses()["Efforts"] == ("OK", "Showing 1 joint; 1 switched off.")
    at.set("joints", {"elbow": False, "shoulder": False})
    assert at.statuses()["Efforts"][0] == "WARN"
    at.press("Efforts")
    assert len(at.nodes()["rings"].segments) == both
    at.set("joints", {"elbow": False, "shoulder": False})
    assert at.nodes() == {}
    assert at.statuses()["Efforts"][0] == "WARN"


def test_names_and_efforts_of_different_number_are_an_error(arm: Benches) -> None:
    at = arm(Effort())
    values = {"name": ["shoulder"], "position": [0.0]}
    at.send("sensor_msgs/msg/JointState", values, frame="", topic="/joint_states")
    at.turn()
    assert at.statuses()["Efforts"] == (
        "ERROR",
        "The message has 0 efforts for 1 joints. Fix the publisher.",
    )


def test_a_missing_description_names_the_node_to_start(bench: Benches) -> None:
    at = bench(Effort())
    measure(at, {"shoulder": 1.0})
    assert at.statuses()["URDF"][1].endswith("Start robot_state_publisher.")
    at.send("std_msgs/msg/String", {"data": "<robot"}, topic="/robot_description")
    at.turn()
    at.settle()
    assert at.statuses()["URDF"][0] == "ERROR"


def test_joints_that_turn_are_read_without_shapes() -> None:
    joints = turning_joints(ARM)
    assert list(joints) == ["shoulder", "elbow"]
    assert (joints["shoulder"].axis, joints["shoulder"].max_effort) == ((0.0, 0.0, 1.0), 10.0)
    assert joints["elbow"].axis == pytest.approx((0, 0.5**0.5, 0.5**0.5))
    with pytest.raises(RobotDescriptionError, match="Two joints"):
        turning_joints(ARM.replace("elbow", "shoulder"))
    unlimited = turning_joints(ARM.replace('effort="10"', 'effort="inf"'))
    assert unlimited["shoulder"].max_effort == 0.0


def test_a_long_name_takes_no_memory_for_each_joint() -> None:
    names = [50_000 * "n", *(f"j{number}" for number in range(2000))]
    tracemalloc.start()
    count = len(names)
    rings = Rings.of(
        names, count * [Pose()], count * [(0.0, 0.0, 1.0)], count * [1.0], count * [2.0]
    )
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert rings.names.tolist() == names
    assert peak < 50e6


class TestEffort(BuiltInChecks):
    display = Effort
    scene = torques
    values: ClassVar = {"joints": [{"slide": False}]}


def test_selecting_effort_of_a_joint(bench: Benches) -> None:
    at = bench(Effort())
    urdf = (
        "<robot name='r'><link name='map'/><link name='odom'/><joint name='elbow' type='revolute'>"
        "<parent link='map'/><child link='odom'/><limit effort='8' velocity='1'/></joint></robot>"
    )
    at.send("std_msgs/msg/String", {"data": urdf}, topic="/robot_description")
    at.turn()
    at.settle()
    at.transform("map", "odom")
    values = {"name": ["elbow"], "effort": [2.0]}
    at.send("sensor_msgs/msg/JointState", values, frame="", topic="/joint_states")
    at.turn()
    check_details(
        at.pick("rings", 3),
        "Joint elbow",
        {"Effort": "2 Nm", "Largest effort": "8 Nm", "Link": "odom"},
    )
