"""The displays of MoveIt in .rviz files, as its setup assistant and its demos write them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from rviz_trees import differences, texts

from webviz.files import opening, rviz
from webviz.shell.cli import main as cli
from webviz_displays.moveit import (
    MotionPlanning,
    MotionPlanningTasks,
    PlanningScene,
    Trajectory,
)

FILE = """\
Visualization Manager:
  Displays:
    - Class: moveit_rviz_plugin/PlanningScene
      Enabled: true
      Move Group Namespace: arm
      Name: Scene
      Planning Scene Topic: /servo/scene
      Robot Description: my_description
      Scene Geometry:
        Scene Alpha: 0.8999999761581421
        Scene Color: 50; 230; 50
        Scene Display Time: 0.20000000298023224
        Show Scene Geometry: true
        Voxel Coloring: Cell Probability
        Voxel Rendering: Disabled
      Scene Robot:
        Attached Body Color: 150; 50; 150
        Links:
          All Links Enabled: false
          Expand Link Details: false
          Link Tree Style: Links in Alphabetic Order
          hand:
            Alpha: 0.5
            Show Axes: false
            Show Trail: true
            Value: true
        Robot Alpha: 1
        Show Robot Collision: false
        Show Robot Visual: true
      Value: true
    - Class: moveit_rviz_plugin/MotionPlanning
      Enabled: true
      MoveIt_Planning_Time: 5
      MoveIt_Workspace:
        Center: {X: 1, Y: 0, Z: 0}
        Size: {X: 2, Y: 2, Z: 4}
      Name: Planning
      Planned Path:
        Color Enabled: true
        Loop Animation: true
        Robot Alpha: 0.25
        State Display Time: 0.05 s
        Trail Step Size: 3
        Trajectory Topic: /my_path
      Planning Metrics:
        Payload: 1
        Show Joint Torques: true
      Planning Request:
        Colliding Link Color: 255; 0; 0
        Goal State Alpha: 0.5
        Planning Group: arm
        Query Goal State: false
      Planning Scene Topic: /monitored_planning_scene
      Robot Description: robot_description
      Value: true
      Velocity_Scaling_Factor: 0.1
    - Class: moveit_rviz_plugin/Trajectory
      Name: Path
      Value: true
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "moveit.rviz"
    path.write_text(FILE)
    return path


def test_a_file_of_moveit_is_read_as_it_is(file: Path) -> None:
    scene, planning, path = opening.load(file).displays
    assert isinstance(scene, PlanningScene)
    assert scene.planning_scene_topic.name == "/servo/scene"
    assert (scene.robot_description.name, scene.move_group_namespace) == ("my_description", "arm")
    assert scene.scene_geometry.voxel_rendering == "Disabled"
    assert scene.scene_geometry.scene_display_time == 0.2
    assert scene.scene_robot.all_links_enabled is False
    assert scene.scene_robot.links["hand"].show_trail
    assert isinstance(planning, MotionPlanning)
    assert planning.trajectory_topic.name == "/my_path"
    assert planning.planned_path.state_display_time == "0.05 s"
    assert planning.planned_path.trail_step_size == 3
    assert planning.planning_request.goal_state_alpha == 0.5
    assert planning.workspace_size == (2.0, 2.0, 4.0)
    assert isinstance(path, Trajectory)
    assert path.trajectory_topic.name == "/display_planned_path", "RViz has the same default"
    assert path.robot_description.name == "robot_description"


def test_nothing_is_lost_and_topics_stay_plain_names(file: Path, tmp_path: Path) -> None:
    yaml, back = tmp_path / "a.yaml", tmp_path / "b.rviz"
    for source, target in ((file, yaml), (yaml, back)):
        assert cli(["convert", str(source), str(target)]) == 0
    assert list(differences(texts(FILE), texts(back.read_text()))) == []
    assert "Trajectory Topic: /my_path" in back.read_text()
    assert "Robot Description: my_description" in back.read_text()


def test_settings_of_planning_do_not_count_but_its_metrics_do(
    file: Path, capsys: pytest.CaptureFixture[Any]
) -> None:
    assert cli(["convert", "--check", str(file)]) == 0
    printed = capsys.readouterr().out
    [line] = [line for line in printed.splitlines() if "unsupported" in line]
    assert "Planning: Planning Metrics/Show Joint Torques" in line
    assert "MoveIt_Planning_Time" not in printed


@pytest.mark.parametrize(("show_axes", "is_lost"), [("false", False), ("true", True)])
def test_links_and_switches_of_old_files_count_if_they_were_changed(
    show_axes: str, is_lost: bool
) -> None:
    _, report = rviz.read(
        f"""\
Visualization Manager:
  Displays:
    - Class: moveit_rviz_plugin/PlanningScene
      Scene Robot:
        Show Scene Robot: true
        hand: {{Alpha: 1, Show Axes: {show_axes}, Show Trail: false, Value: true}}
""",
        "x.rviz",
    )
    assert report.is_complete is not is_lost


@pytest.mark.parametrize(("approach", "is_lost"), [("true", False), ("false", True)])
def test_a_display_of_planning_tasks_is_read_as_it_is(approach: str, is_lost: bool) -> None:
    text = f"""\
Panels:
  - {{Class: moveit_task_constructor/Motion Planning Tasks, Name: Tasks}}
Visualization Manager:
  Displays:
    - Class: moveit_task_constructor/Motion Planning Tasks
      Enabled: true
      Loop Animation: true
      Markers: {{All at once?: true, Value: true, approach: {approach}}}
      Name: Tasks
      Robot:
        Fixed Robot Color: 150; 50; 150
        Links: {{All Links Enabled: false, hand: {{Alpha: 0.5, Value: true}}}}
        Value: ""
      Scene: {{Scene Alpha: 0.5, Value: false}}
      State Display Time: 0.1 s
      Task Solution Topic: /demo/solution
      Tasks: {{pick: 2}}
"""
    config, report = rviz.read(text, "x.rviz")
    [display] = config.displays
    assert isinstance(display, MotionPlanningTasks)
    assert display.task_solution_topic.name == "/demo/solution"
    assert display.robot.links["hand"].alpha == 0.5
    assert not display.robot.all_links_enabled
    assert display.scene.scene_alpha == 0.5
    assert not display.scene.show_scene
    assert display.markers.all_at_once
    assert (display.loop_animation, display.state_display_time) == (True, "0.1 s")
    assert report.is_complete is not is_lost
    assert list(differences(texts(text), texts(rviz.write(config)[0]))) == []
