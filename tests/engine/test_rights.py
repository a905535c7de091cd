"""Allow-list of a viewer: what tools may publish, call and send."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from bench import Bench, Benches

import webviz
from webviz.api.status import Level, Status
from webviz.commands import Load, Redo, Refresh, Reset, SetToolProperty, Undo, UseTool
from webviz.data.messages import encode
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.pipeline.own_names import own_names
from webviz.files.opening import parse
from webviz.panels.nav2 import Nav2
from webviz.shell.app.arguments import report_everything
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import HandFedSource
from webviz.sources import Advertisement, NotConnected, RestrictedGraph, Rights

POINT = ((1.0, 2.0, 0.0),)
TYPE = "geometry_msgs/msg/PointStamped"
NO_PUBLISH = "This viewer was started with --no-publish. Restart it without this option."
OF_START = (
    "{0} is not in the list `publish` of the config that webviz was started with. Let the owner "
    "allow it for this session, or restart with `--allow-publish {0}`."
)
UNUSED = (
    "No tool or panel of the config that webviz was started with uses {0}. Let the owner allow "
    "it for this session, or restart with `--allow-publish {0}`."
)
OF_CONFIG = "{} is not in the list `publish` of this config. Add it to the file."


@pytest.fixture
def make(bench: Benches) -> Callable[..., Any]:
    def make(**options: Any) -> Any:
        b = bench(**options)
        b.source.graph = RememberingGraph()
        b.turn()
        return b

    return make


def use(b: Bench, tool: str = "2D Goal Pose") -> str:
    """The result of using a tool."""
    statuses: list[Status] = []
    b.ask(UseTool(tool, POINT, report=statuses.append))
    assert len(b.graph.published) == (statuses[0].level is Level.OK)
    b.graph.published.clear()
    return statuses[0].text


def refusals(b: Bench) -> dict[str, str]:
    """Return why the tools with one topic cannot be used, by name."""
    names = ("2D Pose Estimate", "2D Goal Pose", "Publish Point")
    tools = (tool for tool in b.do(Refresh()).tools if tool.name in names)
    return {tool.name: tool.refusal for tool in tools if tool.refusal}


@pytest.mark.parametrize(
    ("names", "name", "is_allowed"),
    [
        (("/*",), "/a/b", True),
        ((), "/a", False),
        (("/a",), "/a", True),
        (("/a",), "/a/b", False),
        (("/a",), "/ab", False),
        (("a",), "/a", True),
        (("/nav/*",), "/nav/goal", True),
        (("/nav/*",), "/nav/deep/goal", True),
        (("/nav/*",), "/nav", False),
        (("/*/cmd_vel",), "/robot/cmd_vel", True),
        (("/*/cmd_vel",), "/robot/cmd_vel_raw", False),
        (("/b", "/a"), "/a", True),
        (("/not valid", "/a"), "/a", True),
        (("/a.b",), "/aXb", False),
        (("/go",), "/go/_action/send_goal", True),
        (("/go",), "/stay/_action/send_goal", False),
    ],
)
def test_a_name_is_compared_with_the_list(
    names: tuple[str, ...], name: str, is_allowed: bool
) -> None:
    source = HandFedSource(graph=RememberingGraph())  # pyright: ignore[reportArgumentType]
    restricted_graph = RestrictedGraph(source, Rights(), lambda: names)
    assert (restricted_graph.refusal(name) == "") is is_allowed


def test_names_of_displays_to_add_are_asked_for_once_another_list_lacks_a_name() -> None:
    requests: list[str] = []

    def addable() -> tuple[str, ...]:
        requests.append("addable")
        return ("/menus/feedback",)

    source = HandFedSource(graph=RememberingGraph())  # pyright: ignore[reportArgumentType]
    rights = Rights(publish=None, own=("/goal",), also=("/more",), addable=addable)
    restricted_graph = RestrictedGraph(source, rights, lambda: None)
    assert (restricted_graph.refusal("/goal"), restricted_graph.refusal("/more")) == ("", "")
    assert requests == []
    assert restricted_graph.refusal("/menus/feedback") == ""
    assert restricted_graph.refusal("/other").startswith("No tool or panel of the config")
    assert rights.names == ("/goal", "/menus/feedback")


def test_a_list_of_the_config_asks_for_no_names_of_displays() -> None:
    def addable() -> tuple[str, ...]:
        raise AssertionError

    source = HandFedSource(graph=RememberingGraph())  # pyright: ignore[reportArgumentType]
    rights = Rights(publish=("/goal",), own=("/own",), addable=addable)
    restricted_graph = RestrictedGraph(source, rights, lambda: None)
    assert restricted_graph.refusal("/goal") == ""
    assert restricted_graph.refusal("/own").startswith("/own is not in the list")


def test_refused_requests_never_reach_the_source() -> None:
    graph = RememberingGraph()
    source = HandFedSource(graph=graph)  # pyright: ignore[reportArgumentType]
    rights = Rights(may_publish=False)
    restricted_graph = RestrictedGraph(source, rights, lambda: ("/*",))
    assert restricted_graph.rights is rights
    restricted_graph.advertise({Advertisement("/a", TYPE)})
    goal = restricted_graph.send_goal("/go", "nav2_msgs/action/NavigateToPose", b"", lambda _: None)
    answers = (
        restricted_graph.publish(Advertisement("/a", TYPE), encode(TYPE, {})),
        restricted_graph.call("/empty", "std_srvs/srv/Empty", b"", 1.0),
        goal.accepted,
        goal.result,
    )
    for answer in answers:
        with pytest.raises(NotConnected, match=re.escape(NO_PUBLISH)):
            answer.result(0)
    goal.cancel()
    assert (graph.published, graph.requests, list(graph.advertised)) == ([], [], [])


def test_only_a_stopping_topic_keeps_its_publisher_although_refused() -> None:
    graph = RememberingGraph()
    source = HandFedSource(graph=graph)  # pyright: ignore[reportArgumentType]
    restricted_graph = RestrictedGraph(source, Rights(), lambda: ("/c",))
    a, b, c = (Advertisement(topic, TYPE) for topic in ("/a", "/b", "/c"))
    restricted_graph.advertise({a, b, c}, {a})
    assert set(graph.advertised) == {a, c}


def test_only_the_restricted_graph_reaches_the_graph_of_a_source() -> None:
    files = Path(webviz.__file__).parent.rglob("*.py")
    users = {path for path in files if "source.graph" in path.read_text(encoding="utf-8")}
    # A fleet is a source itself: its graph passes on what the restricted graph allowed.
    assert {path.name for path in users if path.parent.name != "fleet"} == {"restricted_graph.py"}


def test_without_the_right_to_publish_every_tool_has_a_reason(make: Benches) -> None:
    b = make(may_publish=False)
    assert set(refusals(b).values()) == {NO_PUBLISH}
    assert use(b) == NO_PUBLISH
    b.do(Load("version: 1\npublish: ['/*']\n", "x.yaml"))
    assert use(b) == NO_PUBLISH


def test_a_list_refuses_the_tools_it_does_not_name(make: Benches) -> None:
    b = make(publish=("/goal_pose", "/clicked*", "/navigate*"))
    refusal = OF_START.format("/initialpose")
    assert refusals(b) == {"2D Pose Estimate": refusal}
    assert {advertisement.topic for advertisement in b.graph.advertised} == {
        "/goal_pose",
        "/clicked_point",
    }
    assert use(b) == "Published to /goal_pose, 1 subscription."
    assert use(b, "2D Pose Estimate") == refusal
    # A topic that is chosen later counts too.
    b.do(SetToolProperty("2D Goal Pose", "topic.name", "/cmd_vel"))
    assert use(b) == OF_START.format("/cmd_vel")
    b.do(SetToolProperty("2D Pose Estimate", "topic.name", "goal_pose"))
    assert refusals(b) == {"2D Goal Pose": OF_START.format("/cmd_vel")}


def test_a_tool_is_refused_if_all_that_it_uses_is(make: Benches) -> None:
    def refusal(*names: str) -> str:
        tools = make(publish=names).do(Refresh()).tools
        return next(tool.refusal for tool in tools if tool.name == "Nav2 Goal")

    assert refusal() == OF_START.format("/navigate_to_pose")
    assert refusal("/navigate_through_poses") == ""
    assert refusal("/navigate_to_pose") == ""


def test_a_tool_without_a_valid_topic_is_not_refused(make: Benches) -> None:
    b = make(publish=())
    b.do(SetToolProperty("Publish Point", "topic.name", ""))
    assert set(refusals(b)) == {"2D Pose Estimate", "2D Goal Pose"}


def test_a_config_that_is_opened_later_narrows_the_list_and_never_widens_it(make: Benches) -> None:
    b = make(publish=("/goal_pose", "/initialpose", "/navigate*"))
    b.do(Load("version: 1\npublish: ['/*']\n", "all.yaml"))
    assert use(b, "Publish Point") == OF_START.format("/clicked_point")
    b.do(Load("version: 1\npublish: [/initialpose, /clicked_point, /navigate_to_pose]\n", "x.yaml"))
    narrowed = {
        "2D Goal Pose": OF_CONFIG.format("/goal_pose"),
        "Publish Point": OF_START.format("/clicked_point"),
    }
    assert refusals(b) == narrowed
    b.do(Undo())
    assert set(refusals(b)) == {"Publish Point"}
    b.do(Redo())
    b.do(Reset())
    assert refusals(b) == narrowed
    b.do(Undo(steps=100))
    assert set(refusals(b)) == {"Publish Point"}


def test_without_a_list_a_viewer_writes_only_to_names_its_config_uses(make: Benches) -> None:
    b = make(publish=None)
    assert refusals(b) == {}
    assert use(b) == "Published to /goal_pose, 1 subscription."
    b.do(SetToolProperty("2D Goal Pose", "topic.name", "/cmd_vel_raw"))
    assert refusals(b) == {"2D Goal Pose": UNUSED.format("/cmd_vel_raw")}
    assert use(b) == UNUSED.format("/cmd_vel_raw")
    # Nor can a config that is opened from a page; it can have a list.
    config_text = "version: 1\ntools: [{type: GoalPose, topic: /cmd_vel_raw}]\n"
    b.do(Load(config_text, "x.yaml"))
    assert use(b) == UNUSED.format("/cmd_vel_raw")
    b.do(Load(f"{config_text}publish: ['/*']\n", "x.yaml"))
    assert use(b) == UNUSED.format("/cmd_vel_raw")
    b.do(Load("version: 1\npublish: []\n", "x.yaml"))
    assert use(b) == OF_CONFIG.format("/goal_pose")


def test_names_that_are_allowed_besides_need_no_list(make: Benches) -> None:
    for publish in (None, ()):
        b = make(publish=publish, allow_publish=("/robot/*",))
        b.do(SetToolProperty("2D Goal Pose", "topic.name", "/robot/goal"))
        assert use(b) == "Published to /robot/goal, 1 subscription."


USED = """
version: 1
displays:
- {type: Group, displays: [{type: InteractiveMarkers, interactive_markers_namespace: menus}]}
- {type: Nothing}
tools:
- {type: Teleop, topic: {name: drive}}
- {type: Nav2Goal, navigate_to_pose: ""}
panels: [{type: Nav2, namespace: arm}]
"""


def test_a_config_uses_the_names_its_tools_displays_and_panels_write_to() -> None:
    config = parse(USED, "x.yaml")
    names = set(own_names(config, ErrorBoundary("", True)))
    managers = {f"lifecycle_manager_{each}" for each in ("navigation", "localization")}
    services = {f"{each}/{name}" for each in managers for name in ("is_active", "manage_nodes")}
    actions = {"navigate_to_pose", "navigate_through_poses", "follow_waypoints"}
    panel = services | actions
    servers = ("controller", "planner", "smoother", "docking")
    selected = ("controller", "planner", "goal_checker", "smoother", "progress_checker")
    mapping = {
        *("pause_new_measurements", "toggle_interactive_mode", "clear_changes", "clear_queue"),
        *("manual_loop_closure", "save_map", "serialize_map", "deserialize_map", "add_submap"),
        *("merge_submaps", "get_parameters"),
    }
    assert names == {
        "drive",
        "/navigate_through_poses",
        "/follow_waypoints",
        "menus/feedback",
        # Displays and panels that pages may add.
        "/*/feedback",
        "/joint_states",
        *(f"/arm/{name}" for name in panel),
        *(f"/{name}" for name in panel),
        *(f"/{each}_server/get_parameters" for each in servers),
        *(f"/{each}_selector" for each in selected),
        *("/dock_robot", "/undock_robot", "/rviz_visual_tools_gui"),
        *(f"/slam_toolbox/{each}" for each in mapping),
        "rtabmap/republish_node_data",
    }


@pytest.mark.parametrize(
    "config",
    [
        "tools: [{type: GoalPose, topic: '/*'}]",
        "tools: [{type: GoalPose, topic: '/[a-z]*'}]",
        "tools: [{type: Teleop, topic: {name: '/cmd_???'}}]",
        "panels: [{type: Nav2, namespace: '*'}]",
        "displays: [{type: InteractiveMarkers, interactive_markers_namespace: '*'}]",
    ],
)
def test_a_pattern_as_a_property_allows_no_name(config: str) -> None:
    names = own_names(parse(f"version: 1\n{config}\n", "x.yaml"), ErrorBoundary("", True))
    assert {name for name in names if set("*?[") & set(name)} == {"/*/feedback"}


@pytest.mark.parametrize("pattern", ["/*", "*", "/**", "/*/*"])
def test_a_pattern_that_allows_everything_is_reported(
    pattern: str, caplog: pytest.LogCaptureFixture
) -> None:
    report_everything(("/goal_pose", "/arm/*", "~/*", pattern))
    assert caplog.messages == [
        f"The pattern {pattern} lets operators publish and call everything. List names instead, "
        "such as /cmd_vel or /arm/*."
    ]


def test_a_plug_in_whose_names_raise_adds_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def uses(panel: object) -> tuple[str, ...]:
        raise RuntimeError("broken")

    monkeypatch.setattr(Nav2, "uses", property(uses))
    names = own_names(parse("version: 1\n", "x.yaml"), ErrorBoundary("", strict=False))
    assert "/goal_pose" in names
    assert not any("lifecycle" in name for name in names)


def test_every_button_of_a_read_only_source_has_that_reason(make: Benches) -> None:
    b = make()
    assert refusals(b) == {}
    b.source.graph = HandFedSource().graph
    assert set(refusals(b).values()) == {"This source can only be read."}
