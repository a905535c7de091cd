"""Planned paths and states of robots, as MoveIt sends them."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import OTHER_LINKS
from inspecting import Benches
from moveit_scenes import moveit
from robot_arm import describe, is_loaded, wait

from webviz import Instances, Mesh, Topic
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.moveit import MotionPlanning, RobotState, Trajectory
from webviz_displays.moveit.properties import PlannedPath, PlanningRequest
from webviz_urdf import MeshPart, Surface, glb_parts, write_glb

PATH, PATHS = "moveit_msgs/msg/DisplayTrajectory", "/display_planned_path"
STATE, STATES = "moveit_msgs/msg/DisplayRobotState", "/display_robot_state"
URDF = Topic("/robot_description")
UNTURNED = {"w": 1.0}
RAIL = """
<robot name="rail">
  <link name="base"/>
  <link name="cart"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="hook"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="slide" type="prismatic">
    <parent link="base"/><child link="cart"/><axis xyz="1 0 0"/>
    <limit lower="2" upper="8" effort="1" velocity="1"/>
  </joint>
  <joint name="lift" type="prismatic">
    <parent link="cart"/><child link="hook"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="slide" multiplier="2"/>
  </joint>
</robot>
"""


def path(*places: float, joint: str = "slide", every_s: float = 1.0, **more: Any) -> dict[str, Any]:
    points = [
        {"positions": [place], "time_from_start": seconds(number * every_s)}
        for number, place in enumerate(places)
    ]
    single = {"joint_names": [joint], "points": points}
    return {"trajectory": [{"joint_trajectory": single}]} | more


def seconds(time_s: float) -> dict[str, int]:
    return {"sec": int(time_s), "nanosec": round(time_s % 1.0 * 1e9)}


def joints(**positions: float) -> dict[str, Any]:
    names = {"name": list(positions), "position": list(positions.values())}
    return {"joint_state": names | {"header": {"frame_id": "map"}}}


def bench_of(bench: Benches, display: Any) -> DisplayBench:
    at = bench(display)
    at.transform("map", "base")
    describe(at, RAIL)
    return at


def tell(
    at: DisplayBench, values: dict[str, Any], type_name: str = PATH, topic: str = PATHS
) -> None:
    at.send(type_name, values, topic=topic)
    at.turn()


def cart(at: DisplayBench, prefix: str = "path ") -> float:
    return at.poses()[f"{prefix}cart visual visual_0"].position[0]


@pytest.fixture
def rail(bench: Benches) -> DisplayBench:
    """Animated by the clock of the test."""
    return bench_of(bench, Trajectory(robot_description=URDF, use_sim_time=True))


def test_a_path_is_played_at_the_chosen_speed(rail: DisplayBench) -> None:
    tell(rail, path(2.0, 3.0, 4.0, 5.0))
    assert cart(rail) == 2.0
    rail.turn(0.4)
    assert cart(rail) == 3.0
    rail.set("state_display_time", "1x")
    rail.turn(1.0)
    assert cart(rail) == 4.0
    assert rail.statuses()["Path"] == ("OK", "Point 3 of 4 points, at 2.00 s.")
    rail.turn(9.0)
    assert cart(rail) == 5.0
    rail.turn(9.0)
    assert cart(rail) == 5.0
    rail.set("loop_animation", True)
    rail.set("state_display_time", "0.5 s")
    rail.turn(0.1)
    assert cart(rail) == 2.0
    rail.turn(0.6)
    assert cart(rail) == 3.0
    # The joint that mimics goes with it.
    assert rail.poses()["path hook visual visual_0"].position == pytest.approx((3.0, 0.0, 6.0))


def test_a_new_path_waits_for_the_end_of_the_current_one_or_interrupts_it(
    rail: DisplayBench,
) -> None:
    tell(rail, path(2.0, 3.0))
    tell(rail, path(4.0, 5.0))
    assert cart(rail) == 2.0
    rail.turn(0.5)
    assert cart(rail) == 4.0
    rail.set("interrupt_display", True)
    tell(rail, path(6.0, 7.0))
    assert cart(rail) == 6.0


def test_a_slider_shows_any_point(rail: DisplayBench) -> None:
    tell(rail, path(2.0, 3.0, 4.0))
    rail.set("paused", True)
    rail.set("position", 1.0)
    assert cart(rail) == 4.0
    rail.set("position", 0.5)
    rail.turn(10.0)
    assert cart(rail) == 3.0


def test_several_trajectories_follow_each_other_from_the_start_state(rail: DisplayBench) -> None:
    one, two = path(2.5, 3.0), path(4.0, 5.0)
    message = {
        "trajectory": [*one["trajectory"], *two["trajectory"]],
        "trajectory_start": joints(slide=7.0),
    }
    tell(rail, message)
    rail.set("paused", True)
    rail.set("position", 1.0)
    assert cart(rail) == 5.0
    assert rail.statuses()["Path"][1] == "Point 4 of 4 points, at 2.00 s."


def test_a_trail_shows_the_points_that_were_passed(rail: DisplayBench) -> None:
    rail.set("show_trail", True)
    rail.set("trail_step_size", 2)
    tell(rail, path(2.0, 3.0, 4.0, 5.0))
    key = "trail cart visual visual_0 0"
    assert rail.nodes()[key].positions[:, 0].tolist() == [2.0]
    rail.turn(0.7)
    assert rail.nodes()[key].positions[:, 0].tolist() == [2.0, 4.0]
    rail.turn(9.0)
    assert rail.nodes()[key].positions[:, 0].tolist() == [2.0, 4.0, 5.0]
    rail.set("color_enabled", True)
    node = rail.nodes()[key]
    assert isinstance(node, Instances)
    assert node.colors == (150, 50, 150)
    tell(rail, path(*np.linspace(2.0, 3.0, 1001), every_s=0.001))
    rail.turn(1.0)
    assert len(rail.nodes()[key].positions) == 92
    assert rail.statuses()["Trail"][0] == "WARN"


def test_models_of_several_materials_are_repeated_part_by_part() -> None:
    corners = np.eye(3, dtype=np.float32)
    triangle = np.array([[0, 1, 2]], np.uint32)
    red, blue = Surface((1.0, 0.0, 0.0, 1.0)), Surface((0.0, 0.0, 1.0, 0.5))
    parts = [MeshPart(corners, triangle, red), MeshPart(corners * 2, triangle, blue)]
    whole = write_glb(parts)
    one, two = glb_parts(whole)
    assert glb_parts(one) == (one,)
    assert max(len(one), len(two)) < len(whole)
    for data, part in ((one, parts[0]), (two, parts[1])):
        assert part.vertices.tobytes() in data
    assert parts[1].vertices.tobytes() not in one


@pytest.mark.parametrize(
    ("message", "key", "why"),
    [
        (path(), "Path", "The path has no points."),
        ({}, "Path", "The path has no points."),
        (path(2.0, float("nan"), 3.0), "Points", "1 point without a valid position"),
        (path(2.0, 1e308), "Points", "1 point without a valid position"),
        (path(2.0, joint="elbow"), "Joints", "The robot has no joint 'elbow'"),
        (path(2.0, model_id="panda"), "Joints", "The path is for the robot 'panda'"),
        (path(2.0, joint="x" * 1_000_000), "Joints", "The robot has no joint 'xxx"),
        (
            {"trajectory": [{"joint_trajectory": {"points": [{"positions": [1.0]}]}}]},
            "Points",
            "1 point without",
        ),
    ],
)
def test_odd_trajectories_are_reported(
    rail: DisplayBench, message: dict[str, Any], key: str, why: str
) -> None:
    tell(rail, message)
    rail.turn(1.0)
    level, text = rail.statuses()[key]
    assert (level, why in text, len(text) < 500) == ("WARN", True, True)


def test_an_invalid_speed_is_named(rail: DisplayBench) -> None:
    rail.set("state_display_time", "fast")
    rail.turn()
    assert "State Display Time 'fast' is invalid" in rail.statuses()["Speed"][1]
    rail.press("Speed")
    rail.set("state_display_time", "REALTIME")
    assert "Speed" not in rail.statuses()


def test_a_floating_robot_moves_with_its_joint(bench: Benches) -> None:
    at = bench_of(bench, Trajectory(robot_description=URDF, paused=True, position=1.0))
    several = {
        "joint_names": ["world_joint"],
        "points": [
            {"transforms": [{"translation": {"x": x}, "rotation": UNTURNED}]} for x in (0.0, 3.0)
        ],
    }
    tell(at, {"trajectory": [{"multi_dof_joint_trajectory": several}]})
    assert cart(at) == 3.0 + 5.0  # whose joint has its middle position


@pytest.fixture
def state(bench: Benches) -> DisplayBench:
    return bench_of(bench, RobotState(robot_description=URDF, robot_state_topic=Topic(STATES)))


def test_a_state_is_shown_with_the_colors_of_its_links(state: DisplayBench) -> None:
    assert state.statuses()["State"][0] == "WARN"
    red = {"id": "cart", "color": {"r": 1.0, "a": 0.5}}
    tell(state, {"state": joints(slide=3.0), "highlight_links": [red]}, STATE, STATES)
    assert cart(state, "") == 3.0
    node = state.nodes()["cart visual visual_0"]
    assert isinstance(node, Mesh)
    assert (node.color, node.opacity) == ((255, 0, 0), pytest.approx(0.5, abs=0.01))
    state.set("show_highlights", False)
    assert state.nodes()["cart visual visual_0"].opacity == 1.0
    tell(state, {"state": joints(slide=3.0), "hide": True}, STATE, STATES)
    assert state.statuses()["State"] == ("WARN", "Hidden by the publisher.")
    assert state.nodes() == {}


def test_both_ends_of_a_plan_are_shown(bench: Benches) -> None:
    request = PlanningRequest(query_start_state=True, goal_state_alpha=0.5)
    playing = PlannedPath(paused=True, position=0.0)
    at = bench_of(
        bench,
        MotionPlanning(robot_description=URDF, planning_request=request, planned_path=playing),
    )
    tell(at, path(2.0, 4.0, 6.0))
    places = [cart(at, prefix) for prefix in ("start ", "path ", "goal ")]
    assert places == [2.0, 2.0, 6.0]
    goal = at.nodes()["goal cart visual visual_0"]
    assert (goal.color, goal.opacity) == ((250, 128, 0), 0.5)
    topic = "/rviz/moveit/update_custom_goal_state"
    tell(at, joints(slide=9.0), "moveit_msgs/msg/RobotState", topic)
    assert cart(at, "goal ") == 9.0
    assert at.nodes()["goal cart visual visual_0"].color == (255, 0, 255)
    assert at.statuses()["Goal state"][0] == "WARN"
    scene = {"robot_state": joints(slide=3.0), "name": "cell"}
    tell(at, scene, "moveit_msgs/msg/PlanningScene", "/monitored_planning_scene")
    assert cart(at, "") == 3.0
    assert "planning itself is not supported" in at.statuses()["Planning"][1]


def test_the_description_must_come_and_be_readable(bench: Benches) -> None:
    at = bench(Trajectory(robot_description=URDF))
    tell(at, path(2.0))
    assert at.statuses()["URDF"][0] == "WARN"
    at.send("std_msgs/msg/String", {"data": "<robot"}, topic="/robot_description")
    wait(at, lambda: is_loaded(at))
    wait(at, lambda: at.statuses()["URDF"][0] == "ERROR")


class TestMotionPlanning(BuiltInChecks):
    display = MotionPlanning
    messages: ClassVar = {}
    scene = moveit
    later = (
        "move_group_namespace",
        "planned_path.interrupt_display",
        "planned_path.loop_animation",
        "planned_path.state_display_time",
        "planned_path.use_sim_time",
    )
    elsewhere = ("scene_geometry.scene_display_time",)
    needs: ClassVar = {
        "planning_request.start_state_color": {"planning_request.query_start_state": True},
        "planning_request.start_state_alpha": {"planning_request.query_start_state": True},
        "planning_request.goal_state_color": {"planning_request.query_goal_state": True},
        "planning_request.goal_state_alpha": {"planning_request.query_goal_state": True},
        "planned_path.interrupt_display": {"planned_path.use_sim_time": True},
        "planned_path.state_display_time": {"planned_path.use_sim_time": True},
        "planned_path.trail_step_size": {"planned_path.paused": True},
        "planned_path.loop_animation": {
            "planned_path.use_sim_time": True,
            "planned_path.interrupt_display": True,
        },
        "workspace_center": {"planning_request.show_workspace": True},
        "workspace_size": {"planning_request.show_workspace": True},
    }
    values: ClassVar = {"scene_robot.links": OTHER_LINKS, "planned_path.links": OTHER_LINKS}


class TestTrajectory(BuiltInChecks):
    display = Trajectory
    scene = moveit
    variants = (lambda: Trajectory(show_trail=True),)
    later = ("interrupt_display", "loop_animation", "state_display_time", "use_sim_time")
    needs: ClassVar = {
        "interrupt_display": {"use_sim_time": True},
        "state_display_time": {"use_sim_time": True},
        "trail_step_size": {"paused": True},
        "loop_animation": {"use_sim_time": True, "interrupt_display": True},
    }
    values: ClassVar = {"links": OTHER_LINKS}


def test_selecting_link_on_a_path(bench: Benches) -> None:
    at = bench(Trajectory(paused=True))
    moveit(at)
    check_details(
        at.pick("path rider visual visual_0", None, (0.0, 0.0, 0.0)),
        "Link rider",
        {"Point": "Point 4 of 4 points, at 3000.00 s", "Robot": "rail"},
    )


def test_selecting_link_of_a_trail(bench: Benches) -> None:
    at = bench(Trajectory(paused=True, show_trail=True))
    moveit(at)
    check_details(at.pick("trail rider visual visual_0 0", 2), "Link rider", {"Point": "3"})
