"""Panels with buttons and lists: what they send for each."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import pytest
from bench import Benches

from tests.support.panel_facts import show as show_panel
from webviz.api.errors import Error
from webviz.api.panel import Panel
from webviz.commands import Refresh, SetProperty
from webviz.data.messages import decode, encode, interfaces
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.pipeline.own_names import own_names
from webviz.engine.state import Row, State
from webviz.files.config import Config
from webviz.page.recorded_ui import RecordedUi
from webviz.panels.docking import Docking
from webviz.panels.planning_tasks import MotionPlanningTasks
from webviz.panels.selector import Selector
from webviz.panels.slam_toolbox import INITIAL_POSE, SlamToolbox
from webviz.panels.visual_tools import RvizVisualToolsGui
from webviz.shell.testing.harness import OpenedPanel
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz_displays import moveit as displays

PARAMETERS = "rcl_interfaces/srv/GetParameters"


class ServicePanel(OpenedPanel):
    """A panel in a viewer on a graph that remembers."""

    def __init__(self, bench: Benches, cls: type[Panel], **values: Any) -> None:
        self.graph = RememberingGraph()
        self.viewer = bench(graph=self.graph)
        super().__init__(cls, self.viewer.do, self.viewer.viewer, **values)

    def offers(self, service: str, *lists: list[str]) -> None:
        values = [{"type": 9, "string_array_value": each} for each in lists]
        self.graph.responses[service] = encode(f"{PARAMETERS}_Response", {"values": values})


@pytest.fixture
def tools(bench: Benches) -> ServicePanel:
    return ServicePanel(bench, RvizVisualToolsGui)


def test_each_button_presses_its_own(tools: ServicePanel) -> None:
    assert {each.topic for each in tools.graph.advertised} >= {"/rviz_visual_tools_gui"}
    for label in ("Next", "Continue", "Break", "Stop"):
        tools.widget(label).use(None, 1)
    pressed = [message.buttons.tolist() for _, message in tools.graph.published]
    assert pressed == [[int(each == index) for each in range(9)] for index in (1, 2, 3, 4)]
    keys = {each.values["label"]: each.values["key"] for each in tools.ui.commands.values()}
    assert keys["Visual Tools: Next"] == "x"


def test_a_press_without_a_subscription_is_reported(tools: ServicePanel) -> None:
    tools.graph.subscriptions = 0
    tools.widget("Next").use(None, 1)
    assert "No subscription to /rviz_visual_tools_gui" in tools.text()


def test_plug_ins_are_those_of_the_servers_and_the_choice_is_latched(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.panels.selector.ASK_S", 0.0)
    b = ServicePanel(bench, Selector, namespace="/robot1/")
    assert "No names of controller_server, planner_server, smoother_server." in b.text()
    b.offers("/robot1/controller_server/get_parameters", ["MPPI", "RPP"], ["goal"], ["progress"])
    b.offers("/robot1/planner_server/get_parameters", ["GridBased"])
    b.offers("/robot1/smoother_server/get_parameters", [])
    b.show()
    b.show()
    assert b.widget("Controller").values["options"] == ["Default", "MPPI", "RPP"]
    assert b.widget("Goal Checker").values["options"] == ["Default", "goal"]
    assert b.widget("Smoother").values["options"] == ["Default"]
    count = len(b.graph.requests)
    b.show()
    assert len(b.graph.requests) == count, "all servers have answered"
    b.widget("Controller").use("RPP", 1)
    ((advertisement, message),) = b.graph.published
    assert (advertisement.topic, message.data) == ("/robot1/controller_selector", "RPP")
    assert (advertisement.durability, advertisement.depth) == ("transient_local", 1)
    b.show()
    assert b.widget("Controller").values["options"] == ["MPPI", "RPP"]
    assert b.widget("Controller").value == "RPP"


def test_the_end_of_a_replaced_goal_is_not_shown(bench: Benches) -> None:
    b = ServicePanel(bench, Docking)
    b.widget("Dock id").use("home", 1)
    for _ in range(2):
        b.widget("Dock").use(None, 1)
        b.graph.goals[-1].accepted.set_result(True)
        b.viewer.do(Refresh())
    answer = encode("nav2_msgs/action/DockRobot_GetResult_Response", {"status": 6})
    b.graph.goals[-2].result.set_result((6, answer))
    b.viewer.do(Refresh())
    assert "borted" not in b.text(), "the newer goal is active"


def test_a_robot_docks_by_id_and_at_a_pose_and_undocks(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.panels.docking.ASK_S", 0.0)
    b = ServicePanel(bench, Docking)
    with pytest.raises(Error, match="No dock id"):
        b.widget("Dock").use(None, 1)
    b.widget("Dock id").use("home", 1)
    b.widget("Dock").use(None, 1)
    goal = b.graph.goals[-1]
    assert (goal.action, goal.values.dock_id, goal.values.use_dock_id) == (
        "/dock_robot",
        "home",
        True,
    )
    assert (goal.values.max_staging_time, goal.values.navigate_to_staging_pose) == (1000.0, True)
    goal.accepted.set_result(True)
    b.viewer.do(Refresh())
    feedback = {"feedback": {"state": 3, "docking_time": {"sec": 4}, "num_retries": 1}}
    goal.feedback(encode("nav2_msgs/action/DockRobot_FeedbackMessage", feedback))
    (progress,) = b.viewer.do(Refresh()).goals
    assert (progress.title, progress.label) == ("Docking", "home")
    assert progress.values.get("State") == "controlling"
    result = {"status": 6, "result": {"error_code": 904}}
    answer = encode("nav2_msgs/action/DockRobot_GetResult_Response", result)
    goal.result.set_result((6, answer))
    (progress,) = b.viewer.do(Refresh()).goals
    assert progress.status is not None
    assert "Failed (904): the dock was not detected" in progress.status.text
    assert progress.status.text in b.text(), "it no longer says that the goal is accepted"

    b.offers("/docking_server/get_parameters", ["simple"])
    b.show()
    b.show()
    assert b.widget("Dock type").values["options"] == ["Default", "simple"]
    b.widget("Dock type").use("simple", 1)
    b.widget("By id").use(False, 1)
    for label, text in (("x (m)", "1"), ("y (m)", "-2"), ("yaw (rad)", str(math.pi))):
        b.widget(label).use(text, 1)
    b.widget("Dock").use(None, 1)
    values = b.graph.goals[-1].values
    assert (values.dock_pose.header.frame_id, values.dock_type) == ("map", "simple")
    position, turn = values.dock_pose.pose.position, values.dock_pose.pose.orientation
    assert (position.x, position.y, turn.z) == (1.0, -2.0, 1.0)
    b.widget("x (m)").use("far", 1)
    with pytest.raises(Error, match="`far` is not a number"):
        b.widget("Dock").use(None, 1)

    # The previous goal has to end first.
    b.graph.goals[-1].accepted.set_result(False)
    b.viewer.do(Refresh())
    b.widget("Undock").use(None, 1)
    goal = b.graph.goals[-1]
    assert (goal.action, goal.values.dock_type) == ("/undock_robot", "simple")


@pytest.fixture
def slam(bench: Benches, monkeypatch: pytest.MonkeyPatch) -> ServicePanel:
    monkeypatch.setattr("webviz.panels.slam_toolbox.ASK_S", 0.0)
    return ServicePanel(bench, SlamToolbox)


def last_request(b: ServicePanel) -> Any:
    """Name and decoded request of the newest call that is not for the state."""
    service, type_, request = next(
        each for each in reversed(b.graph.requests) if each[1] != PARAMETERS
    )
    return service, decode(interfaces.service(type_).request, request)


def response(name: str, values: dict[str, Any]) -> bytes:
    return encode(interfaces.service(f"slam_toolbox/srv/{name}").response, values)


def test_the_buttons_of_slam_toolbox_follow_its_state(slam: ServicePanel) -> None:
    assert "No node offers /slam_toolbox/get_parameters" in slam.text()
    values = {"values": [{"type": 1, "bool_value": True}, {"type": 1}]}
    answer = encode(f"{PARAMETERS}_Response", values)
    slam.graph.responses["/slam_toolbox/get_parameters"] = answer
    slam.show()
    assert "'paused'" in slam.text()
    assert slam.widget("Start editing")
    slam.graph.responses["/slam_toolbox/pause_new_measurements"] = response(
        "Pause", {"status": True}
    )
    slam.widget("Use new scans").use(None, 1)
    assert "Done." in slam.text()
    assert last_request(slam)[0] == "/slam_toolbox/pause_new_measurements"


@pytest.mark.parametrize(
    ("button", "service"),
    [
        ("Start editing", "toggle_interactive_mode"),
        ("Clear changes", "clear_changes"),
        ("Save changes", "manual_loop_closure"),
        ("Clear queue", "clear_queue"),
        ("Generate map", "merge_submaps"),
    ],
)
def test_a_button_of_slam_toolbox_calls_its_service(
    button: str, service: str, slam: ServicePanel
) -> None:
    slam.widget(button).use(None, 1)
    assert last_request(slam)[0] == f"/slam_toolbox/{service}"
    assert f"No node offers /slam_toolbox/{service}" in slam.text()


def test_maps_and_pose_graphs_are_saved_and_loaded(slam: ServicePanel) -> None:
    for button in ("Save map", "Serialize", "Deserialize", "Add submap"):
        with pytest.raises(Error, match="No file for"):
            slam.widget(button).use(None, 1)
    slam.widget("Map").use(" office ", 1)
    result = response("SaveMap", {"result": 1})
    slam.graph.responses["/slam_toolbox/save_map"] = result
    slam.widget("Save map").use(None, 1)
    assert last_request(slam)[1].name.data == "office"
    assert "Failed: slam_toolbox has no map yet." in slam.text()

    slam.widget("Pose graph").use("/maps/office", 1)
    slam.widget("Serialize").use(None, 1)
    assert last_request(slam)[1].filename == "/maps/office"
    slam.widget("Deserialize").use(None, 1)
    assert last_request(slam)[1].match_type == 1
    pose = {"position": {"x": 1.0, "y": -2.0}, "orientation": {"z": 2.0, "w": 0.0}}
    message = decode(INITIAL_POSE, encode(INITIAL_POSE, {"pose": {"pose": pose}}))
    assert slam.panel.subscriptions() == {"/initialpose": INITIAL_POSE}
    slam.panel.take("/initialpose", message)
    slam.widget("Deserialize").use(None, 1)
    request = last_request(slam)[1]
    assert (request.match_type, request.initial_pose.x, request.initial_pose.y) == (2, 1.0, -2.0)
    assert request.initial_pose.theta == pytest.approx(3.14)
    slam.widget("yaw (rad)").use("north", 1)
    with pytest.raises(Error, match="`north` is not a number"):
        slam.widget("Deserialize").use(None, 1)
    slam.widget("Submap").use("hall", 1)
    slam.widget("Add submap").use(None, 1)
    assert last_request(slam)[1].filename == "hall"


def test_names_the_panels_send_to_are_allowed() -> None:
    names = own_names(Config(), ErrorBoundary("", strict=True))
    for name in ("/rviz_visual_tools_gui", "/planner_selector", "/dock_robot", "/undock_robot"):
        assert name in names
    assert "/docking_server/get_parameters" in names
    assert "/slam_toolbox/save_map" in names
    request = encode(f"{PARAMETERS}_Request", {"names": ["dock_plugins"]})
    assert decode(f"{PARAMETERS}_Request", request).names == ["dock_plugins"]


def test_the_solution_to_play_is_chosen_among_those_of_the_stages() -> None:
    messages: list[tuple[Any, int | None]] = []
    ui, panel = RecordedUi(), MotionPlanningTasks()
    panel.build(ui, lambda command, browser=None: messages.append((command, browser)))

    def chosen(*rows: Row) -> str:
        show_panel(panel, State(rows=rows))
        return str([widget.values for widget in ui.widgets.values()])

    assert "Add one to see the stages" in chosen()
    display = displays.MotionPlanningTasks()
    row = Row("d1", "MotionPlanningTasks", display, "Tasks", {})
    assert "No task received" in chosen(row)
    offered = {"solution": {"7: pick": 7}, "stages": {"1 pick": 1}, "failed": {"1 pick": 4}}
    text = chosen(msgspec.structs.replace(row, offered=offered))
    assert all(each in text for each in ("7: pick", "1 pick", "4", "Newest"))
    choice = next(w for w in ui.widgets.values() if w.values.get("label") == "Solution")
    choice.use("7: pick", 3)
    choice.use("Newest", 3)
    assert messages == [(SetProperty("d1", "solution", id), 3) for id in (7, 0)]
