"""A robot that is placed by joint states, without robot_state_publisher."""

from __future__ import annotations

from typing import Any

import pytest
from inspecting import Benches
from robot_arm import is_loaded, wait

from webviz.shell.testing import DisplayBench
from webviz_displays.robot_model import RobotModel
from webviz_displays.robot_model.parts import GREY

NAN = float("nan")

RAIL = """
<robot name="rail">
  <link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="cart"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="mast"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="slide" type="prismatic">
    <parent link="base"/><child link="cart"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="turn" type="continuous"><parent link="cart"/><child link="mast"/></joint>
</robot>
"""


@pytest.fixture
def rail(bench: Benches) -> DisplayBench:
    """The robot, 5 m along x, without a joint state."""
    at = bench(RobotModel(joint_source="Joint states"))
    at.transform("map", "base", (5.0, 0.0, 0.0))
    at.send("std_msgs/msg/String", {"data": RAIL}, topic="/robot_description")
    wait(at, lambda: is_loaded(at))
    return at


def report(at: DisplayBench, **positions: float) -> None:
    state = {"name": list(positions), "position": list(positions.values())}
    at.send("sensor_msgs/msg/JointState", state, topic="/joint_states")
    at.turn()


def test_joint_states_of_several_publishers_place_the_links(rail: DisplayBench) -> None:
    assert rail.statuses()["Joints"][0] == "ERROR"
    report(rail, slide=0.5)
    level, text = rail.statuses()["Joints"]
    assert level == "ERROR"
    assert text.startswith("1 of 2 joints without a position: turn.")
    assert rail.nodes()["mast visual visual_0"].color == GREY
    assert rail.nodes()["cart visual visual_0"].color != GREY
    report(rail, turn=1.0, of_another_robot=3.0)
    assert rail.statuses()["Joints"] == ("OK", "The positions of 2 joints are known.")
    assert rail.statuses()["Links"] == ("OK", "3 links placed by joint states.")
    assert rail.nodes()["mast visual visual_0"].color != GREY
    assert rail.poses()["mast visual visual_0"].position == pytest.approx((5.5, 0.0, 0.0))
    rail.transform("map", "base", (6.0, 0.0, 0.0))
    rail.turn()
    assert rail.poses()["mast visual visual_0"].position == pytest.approx((6.5, 0.0, 0.0))


def test_the_root_link_needs_a_transform(rail: DisplayBench) -> None:
    report(rail, slide=0.5, turn=0.0)
    rail.fixed_frame = "elsewhere"
    rail.turn()
    assert rail.statuses()["Links"][0] == "ERROR"
    assert "elsewhere" in rail.statuses()["Link base"][1]
    rail.fixed_frame = "base"
    rail.turn()
    assert rail.statuses()["Links"][0] == "OK"


@pytest.mark.parametrize(
    ("state", "why"),
    [
        ({"name": ["slide", "turn"], "position": [1.0]}, "2 names but 1 position"),
        ({"name": ["slide"], "position": [NAN]}, "'slide': nan"),
        ({"name": ["slide"], "position": [1e300]}, "'slide': 1e+300"),
    ],
)
def test_invalid_joint_states_are_reported_and_change_nothing(
    rail: DisplayBench, state: dict[str, Any], why: str
) -> None:
    report(rail, slide=0.5, turn=0.0)
    before = rail.poses()
    rail.send("sensor_msgs/msg/JointState", state, topic="/joint_states")
    rail.turn()
    level, text = rail.statuses()["Joint states"]
    assert level == "ERROR"
    assert why in text
    assert rail.poses() == before
    rail.send("sensor_msgs/msg/JointState", {"name": ["slide"]}, topic="/joint_states")
    rail.turn()
    assert "Joint states" not in rail.statuses()


def test_names_without_end_are_not_all_remembered(
    rail: DisplayBench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz_displays.robot_model.joint_states.MAX_JOINTS", 3)
    report(rail, **{f"unknown_{i}": 0.0 for i in range(2)})
    report(rail, slide=0.1, more=1.0, turn=1.0)
    report(rail, slide=0.2)
    assert rail.poses()["cart visual visual_0"].position == pytest.approx((5.2, 0.0, 0.0))
    assert "turn" in rail.statuses()["Joints"][1]


def test_the_update_interval_holds_links_until_the_next_round(rail: DisplayBench) -> None:
    rail.set("update_interval", 1.0)
    report(rail, slide=0.1, turn=0.0)
    rail.turn(1.0)
    report(rail, slide=0.9)
    assert rail.poses()["cart visual visual_0"].position == pytest.approx((5.1, 0.0, 0.0))
    rail.turn(1.0)
    assert rail.poses()["cart visual visual_0"].position == pytest.approx((5.9, 0.0, 0.0))
