"""The toolbar of a .rviz file, both ways."""

from __future__ import annotations

import json
from typing import Any

import pytest
from ruamel.yaml import YAML

from webviz.api.declared import set_property, to_values
from webviz.api.tool import Tool
from webviz.files import rviz
from webviz.files.config import Config, all_panels, dump
from webviz.files.opening import parse
from webviz.panels.nav2 import Nav2
from webviz.tools.goal_pose import GoalPose
from webviz.tools.nav2_goal import Nav2Goal
from webviz.tools.pose_estimate import PoseEstimate
from webviz.tools.publish_point import PublishPoint
from webviz.tools.teleop import Teleop

TOOLS = """\
Visualization Manager:
  Tools:
    - {Class: rviz_default_plugins/MoveCamera}
    - Class: rviz_default_plugins/SetGoal
      Odd: 007
      Topic: {Value: /go, Depth: 9, Reliability Policy: Best Effort, History Policy: Keep Last}
    - {Class: nav2_rviz_plugins/CostmapCostTool, Own: [1, 2]}
    - {Class: rviz_default_plugins/SetGoal, Topic: /second}
"""

QOS = {
    "Depth": 5,
    "Durability Policy": "Volatile",
    "History Policy": "Keep Last",
    "Reliability Policy": "Reliable",
}


def read_tools(tools: str) -> tuple[Config, rviz.Report]:
    return rviz.read(f"Visualization Manager:\n  Tools: {tools}\n", "x.rviz")


def tools_of(config: Config) -> Any:
    """The list of tools in the file, after a save as YAML."""
    text, _ = rviz.write(parse(dump(config), "x.yaml"))
    return YAML(typ="safe", pure=True).load(text)["Visualization Manager"].get("Tools")


def goals(config: Config) -> list[Tool]:
    *tools, last = config.tools
    assert type(last) is Teleop
    assert all(type(tool) is GoalPose for tool in tools)
    return [tool for tool in tools if isinstance(tool, GoalPose)]


def test_tools_with_a_counterpart_are_imported_with_their_properties() -> None:
    first, second = goals(rviz.read(TOOLS, "x.rviz")[0])
    topic = {"name": "/go", "reliability": "best_effort", "depth": 9}
    assert to_values(first) == {"topic": topic}
    assert to_values(second) == {"topic": "/second"}


def test_the_toolbar_comes_back_in_its_order_with_every_key() -> None:
    camera, goal, foreign, second = tools_of(rviz.read(TOOLS, "x.rviz")[0])
    assert (camera["Class"], foreign["Class"]) == (
        "rviz_default_plugins/MoveCamera",
        "nav2_rviz_plugins/CostmapCostTool",
    )
    assert foreign["Own"] == [1, 2]
    assert str(goal["Odd"]) == "007"
    assert goal["Topic"]["Value"] == "/go"
    assert goal["Topic"]["Depth"] == 9
    assert goal["Topic"]["Reliability Policy"] == "Best Effort"
    assert second["Topic"] == "/second"


def test_estimates_and_points_come_back_as_they_were() -> None:
    tools = [
        {"Class": "rviz_default_plugins/Interact", "Hide Inactive Objects": True},
        {"Class": "rviz_default_plugins/MoveCamera"},
        {"Class": "rviz_default_plugins/Select"},
        {"Class": "rviz_default_plugins/FocusCamera"},
        {"Class": "rviz_default_plugins/Measure", "Line color": "128; 128; 0"},
        {
            "Class": "rviz_default_plugins/SetInitialPose",
            "Covariance x": 0.5,
            "Covariance y": 0.25,
            "Covariance yaw": 0.1,
            "Topic": {"Value": "/estimate", **QOS},
        },
        {
            "Class": "rviz_default_plugins/PublishPoint",
            "Single click": False,
            "Topic": {"Value": "/point", **QOS},
        },
        {
            "Class": "rviz_default_plugins/SetGoal",
            "Confirm": True,
            "Topic": {"Value": "/goal", **QOS, "Durability Policy": "Transient Local"},
        },
    ]
    config, report = read_tools(json.dumps(tools))
    assert report.sentences() == []
    estimate, point, goal, _ = config.tools
    assert isinstance(estimate, PoseEstimate)
    assert isinstance(point, PublishPoint)
    assert (estimate.covariance_x, estimate.covariance_yaw) == (0.5, 0.1)
    assert (estimate.topic.name, point.topic.name) == ("/estimate", "/point")
    assert point.stays
    assert isinstance(goal, GoalPose)
    assert goal.asks
    assert tools_of(config) == tools


def test_the_goal_tool_of_nav2_returns_with_its_changes() -> None:
    config, _ = read_tools("[{Class: nav2_rviz_plugins/GoalTool, Own: [1, 2]}]")
    tool = config.tools[0]
    assert isinstance(tool, Nav2Goal)
    set_property(tool, "behavior_tree", "/trees/slow.xml")
    set_property(tool, "navigate_to_pose", "/r1/navigate_to_pose")
    (entry,) = tools_of(config)
    assert (entry["Class"], entry["Own"]) == ("nav2_rviz_plugins/GoalTool", [1, 2])
    assert entry["Behavior Tree"] == "/trees/slow.xml"
    again = read_tools(json.dumps([entry]))[0].tools[0]
    assert isinstance(again, Nav2Goal)
    assert to_values(again) == to_values(tool)


def test_a_changed_tool_is_written_in_its_place() -> None:
    config, _ = rviz.read(TOOLS, "x.rviz")
    set_property(goals(config)[1], "topic.name", "/third")
    _, goal, _, second = tools_of(config)
    assert (goal["Topic"]["Value"], second["Topic"]["Value"]) == ("/go", "/third")


def test_a_removed_tool_is_not_written_again() -> None:
    config, _ = rviz.read(TOOLS, "x.rviz")
    del config.tools[0]
    assert [tool["Class"].rpartition("/")[2] for tool in tools_of(config)] == [
        "MoveCamera",
        "SetGoal",
        "CostmapCostTool",
    ]


@pytest.mark.parametrize(("key", "entries"), [("Odd: 1", None), ("Tools: 5", 5)])
def test_a_file_without_a_list_of_tools_is_saved_without_one(key: str, entries: int | None) -> None:
    config, _ = rviz.read(f"Visualization Manager:\n  {key}\n", "x.rviz")
    tools = [tool for tool in config.tools if isinstance(tool, Tool)]
    assert tools
    assert not any(map(to_values, tools))
    assert tools_of(config) == entries
    set_property(tools[0], "topic.name", "/go")
    assert len(tools_of(config)) > 5


def test_only_a_tool_that_rviz_lacks_is_added_to_a_toolbar_without_a_counterpart() -> None:
    config, _ = read_tools("[{Class: rviz_default_plugins/Measure}]")
    (teleop,) = config.tools
    assert isinstance(teleop, Teleop)
    _, report = rviz.write(config)
    assert report.sentences() == []
    assert tools_of(config) == [{"Class": "rviz_default_plugins/Measure"}]
    set_property(teleop, "linear", 0.2)
    _, report = rviz.write(config)
    assert report.sentences() == ["Teleop: Teleop: skipped, because RViz has no such tool."]


def test_a_tool_without_its_topic_has_the_default_one() -> None:
    config, report = read_tools("[{Class: rviz_default_plugins/SetGoal}]")
    assert to_values(goals(config)[0]) == {}
    assert report.sentences() == []
    assert report.carried["tools"] == 1


def test_a_fault_of_a_tool_is_reported_with_its_line() -> None:
    _, report = read_tools("[{Class: rviz/SetGoal, Topic: {Value: /a, Depth: deep}, Glow: 1}]")
    assert report.sentences() == [
        "2D Goal Pose (line 2): Topic/Depth: expected a number, got `deep`.",
        "2D Goal Pose: Glow: unsupported; kept for export.",
    ]


def test_a_panel_of_rviz_that_is_a_plug_in_here_is_opened_once() -> None:
    text = """\
Panels:
  - {Class: rviz_common/Displays}
  - {Class: nav2_rviz_plugins/Navigation 2}
  - {Class: nav2_rviz_plugins/Navigation 2}
  - {Class: acme/Other}
Visualization Manager: {}
"""
    config, report = rviz.read(text, "x.rviz")
    every = [type(panel) for panel in all_panels()]
    assert [type(panel) for panel in config.panels] == [*every, Nav2]
    assert (report.carried["panels"], report.total["panels"]) == (3, 4)


def test_deviations_of_ros_1_are_variances() -> None:
    config, report = read_tools(
        "[{Class: rviz_default_plugins/SetInitialPose, X std deviation: 0.2}]"
    )
    (estimate,) = (each for each in config.tools if isinstance(each, PoseEstimate))
    assert estimate.covariance_x == pytest.approx(0.04)
    assert report.sentences() == []
    set_property(estimate, "covariance_x", 0.5)
    (entry,) = tools_of(config)
    assert (entry["Covariance x"], entry["X std deviation"]) == (0.5, 0.2)
    again, _ = rviz.read(rviz.write(config)[0], "x.rviz")
    assert [each.covariance_x for each in again.tools if isinstance(each, PoseEstimate)] == [0.5]


PANEL = """\
Panels:
  - {Class: rviz_plugin_tutorials/Teleop, Name: Drive, Topic: /robot1/cmd_vel}
Visualization Manager: {}
"""


def test_the_panel_teleop_of_the_tutorials_is_the_tool() -> None:
    config, report = rviz.read(PANEL, "x.rviz")
    (teleop,) = (tool for tool in config.tools if isinstance(tool, Teleop))
    assert teleop.topic.name == "/robot1/cmd_vel"
    assert report.is_complete
    text, report = rviz.write(config)
    assert report.sentences() == []
    panels = YAML(typ="safe", pure=True).load(text)["Panels"]
    assert panels == [
        {"Class": "rviz_plugin_tutorials/Teleop", "Name": "Drive", "Topic": "/robot1/cmd_vel"}
    ]
    set_property(teleop, "topic.name", "/other")
    text, report = rviz.write(config)
    assert report.sentences() == []
    assert YAML(typ="safe", pure=True).load(text)["Panels"][0]["Topic"] == "/other"
    set_property(teleop, "linear", 2.0)
    assert rviz.write(config)[1].sentences() == [
        "Teleop: Teleop: skipped, because RViz has no such tool."
    ]
