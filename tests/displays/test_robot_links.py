"""Links and joints of the RobotModel display: where they are, and what is said of them."""

from typing import ClassVar

import pytest
from built_in_checks import BuiltInChecks
from display_scenes import OTHER_LINKS
from inspecting import Benches
from moveit_scenes import moveit
from robot_arm import ARM, describe, place_arm

from webviz import Mesh
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.moveit import RobotState
from webviz_displays.robot_model import RobotModel
from webviz_displays.robot_model.parts import GREY, JointSettings, LinkSettings


def test_a_link_that_loses_its_transform_turns_grey_where_it_was(arm: DisplayBench) -> None:
    before = arm.poses()["tool visual grip"]
    arm.buffer.clear()  # forgets what moves
    arm.turn()
    assert arm.poses()["tool visual grip"] == before
    assert arm.nodes()["tool visual grip"].color == GREY
    assert arm.nodes()["base visual visual_0"].color == (0, 0, 255)
    level, text = arm.statuses()["Links"]
    assert level == "ERROR"
    assert text.startswith("1 of 2 links without a transform: tool.")
    assert arm.statuses()["Link tool"][0] == "ERROR"
    assert "tool" in arm.statuses()["Link tool"][1]
    place_arm(arm)
    arm.turn()
    assert arm.nodes()["tool visual grip"].color == (0, 0, 255)
    assert arm.statuses()["Links"][0] == "OK"


def test_a_link_that_never_had_a_transform_is_not_drawn(bench: Benches) -> None:
    at = bench(RobotModel())
    at.transform("map", "base", (1.0, 0.0, 0.0))
    describe(at, ARM)
    at.turn()
    assert set(at.nodes()) == {"base visual visual_0"}
    assert "tool" in at.statuses()["Links"][1]


def test_the_prefix_names_the_frames_of_one_robot_of_several(bench: Benches) -> None:
    at = bench(RobotModel(tf_prefix="robot_1"))
    at.transform("map", "robot_1/base", (1.0, 0.0, 0.0))
    at.transform("map", "robot_1/tool", (2.0, 0.0, 0.0))
    at.transform("map", "base", (9.0, 0.0, 0.0))
    describe(at, ARM)
    assert at.poses()["base visual visual_0"].position == pytest.approx((1.0, 0.0, 0.0))
    at.set("tf_prefix", "/robot_1/")
    assert at.poses()["base visual visual_0"].position == pytest.approx((1.0, 0.0, 0.0))
    at.set("tf_prefix", "")
    assert at.poses()["base visual visual_0"].position == pytest.approx((9.0, 0.0, 0.0))


def test_links_without_a_transform_are_counted_with_one_reason_each(
    bench: Benches,
) -> None:
    links = "".join(f'<link name="l{n}"/>' for n in range(20))
    joints = "".join(
        f'<joint name="j{n}" type="{"fixed" if n < 9 else "continuous"}"><parent link="l0"/>'
        f'<child link="l{n}"/></joint>'
        for n in range(1, 20)
    )
    at = bench(RobotModel())
    at.transform("map", "l0")
    describe(at, f"<robot name='r'>{links}{joints}</robot>")
    at.turn()
    statuses = at.statuses()
    assert {key: text for key, (_, text) in statuses.items() if key.startswith("Link ")} == {
        "Link l1": "No transform to 'l1' has arrived. Start robot_state_publisher with this "
        "description.",
        "Link l9": "No transform to 'l9' has arrived: the state of its joint 'j9' is probably not "
        "published. Start the driver or joint_state_publisher, which publish /joint_states.",
    }
    assert "19 of 20 links" in statuses["Links"][1]
    assert "l5 and 14 more" in statuses["Links"][1]


def test_a_missing_fixed_frame_is_reported_once_for_all_links(bench: Benches) -> None:
    at = bench(RobotModel())
    place_arm(at)
    at.fixed_frame = "earth"
    describe(at, ARM)
    sentences = [text for _, text in at.statuses().values() if "does not exist" in text]
    assert len(sentences) == 1


def test_links_move_no_more_often_than_the_update_interval(bench: Benches) -> None:
    at = bench(RobotModel(update_interval=1.0))
    place_arm(at)
    describe(at, ARM)
    for step, expected in ((0.5, 3.0), (0.6, 6.0)):
        at.transform("base", "tool", (0.0, 2 * expected, 0.0), stamp_ns=at.now_ns + 10**8)
        at.transform("base", "tool", (0.0, 6.0, 0.0), stamp_ns=at.now_ns + 2 * 10**8)
        at.turn(step)
        assert at.poses()["tool visual grip"].position[1] == pytest.approx(expected)


def test_a_trail_is_the_last_two_metres_of_a_links_way(bench: Benches) -> None:
    at = bench(RobotModel(links={"tool": LinkSettings(show_trail=True)}))
    place_arm(at)
    describe(at, ARM)
    for step in range(1, 301):
        at.now_ns += 10**7
        at.transform("base", "tool", (0.0, 3.0 + 0.025 * step, 0.0), stamp_ns=at.now_ns)
        at.turn()
    trail = at.xyz("tool trail")
    assert trail.shape == (99, 2, 3)
    assert trail[-1, 1] == pytest.approx((1.0, 10.5, 0.0))
    assert (trail[1:, 0] == trail[:-1, 1]).all()
    at.turn(1.0)
    assert len(at.xyz("tool trail")) == 99  # who stands still leaves no points
    at.fixed_frame = "base"
    at.turn()
    assert "tool trail" not in at.nodes()


def test_statuses_of_shown_axes_give_poses_of_links_and_motions_of_joints(
    bench: Benches,
) -> None:
    at = bench(RobotModel(links={"tool": LinkSettings(show_axes=True)}))
    place_arm(at)
    describe(at, ARM)
    assert at.statuses()["Link tool"] == (
        "OK",
        "Position (1.000, 3.000, 0.000) m, "
        "orientation x, y, z, w (1.0000, 0.0000, 0.0000, 0.0000).",
    )
    at.set("joints", {"wrist": JointSettings()})
    assert at.statuses()["Joint wrist"] == (
        "OK",
        "Continuous, from base to tool, axis (1, 0, 0).",
    )


def test_settings_for_links_and_joints_that_the_robot_does_not_have_are_named(
    bench: Benches,
) -> None:
    at = bench(RobotModel(links={"tol": LinkSettings()}, joints={"wirst": JointSettings()}))
    place_arm(at)
    describe(at, ARM)
    statuses = at.statuses()
    assert statuses["Link settings"] == ("WARN", "The robot has no link named tol.")
    assert statuses["Joint settings"] == ("WARN", "The robot has no joint named wirst.")


def test_a_tick_without_changes_keeps_all_nodes(bench: Benches) -> None:
    at = bench(RobotModel(alpha=0.5))
    place_arm(at)
    describe(at, ARM)
    before = at.nodes()
    at.transform("base", "tool", (0.0, 4.0, 0.0), stamp_ns=at.now_ns + 1)
    at.turn(0.1)
    after = at.nodes()
    assert at.poses()["tool visual grip"].position == pytest.approx((1.0, 4.0, 2.0))
    assert all(after[key] is before[key] for key in before)
    assert all(isinstance(node, Mesh) for node in after.values())


class TestRobotState(BuiltInChecks):
    display = RobotState
    scene = moveit
    values: ClassVar = {"links": OTHER_LINKS}


def test_selecting_an_attached_object(bench: Benches) -> None:
    at = bench(RobotState())
    moveit(at)
    check_details(
        at.pick("attached box", 0), "Object 'cup'", {"Attached to": "rider", "Shapes": "1 box"}
    )
