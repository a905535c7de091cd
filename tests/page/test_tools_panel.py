"""The panel "Tools": what was sent, and the properties of the tools."""

from __future__ import annotations

from msgspec.structs import replace

from tests.page.conftest import Tab
from webviz.api.declared import make
from webviz.api.status import Level, Status
from webviz.api.tool import Tool
from webviz.commands import SetToolProperty, UseTool
from webviz.features.tools.toolbar import ToolButton
from webviz.files.config import Settings
from webviz.tools.goal_pose import GoalPose
from webviz.tools.pose_estimate import PoseEstimate

SEND = """async () => {
  const history = await import("webviz/features/tools/history.js");
  const goal = { id: "t1", name: "2D Goal Pose", gesture: "pose" };
  history.send(goal, { points: [[1, 2, 0.5]], yaw: Math.PI / 2, keys: [] });
}"""

ASKS = """async () => (await import("webviz/tools/registry.js")).all().some(({ asks }) => asks)"""


def button(id_: str, cls: type[Tool]) -> ToolButton:
    tool = make(cls, {})
    return ToolButton(id_, tool.name, "", "", "pose", tool=tool)


def shown(tab: Tab) -> None:
    tools = (button("t1", GoalPose), button("t2", PoseEstimate))
    tab.loop.show(tools=tools, settings=Settings(fixed_frame="map"))
    tab.show_tab("Tools")


def test_each_tool_has_its_properties(tab: Tab) -> None:
    shown(tab)
    field = tab.page.locator("[data-path='covariance_yaw'] input")
    tab.wait_for(field.is_visible)
    field.fill("0.5")
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(SetToolProperty("t2", "covariance_yaw", 0.5))
    topics = tab.page.locator("[data-path='topic.name'] input")
    assert [topic.input_value() for topic in topics.all()] == ["/goal_pose", "/initialpose"]


def test_a_tool_that_asks_asks_again(tab: Tab) -> None:
    shown(tab)
    tab.page.evaluate(SEND)
    tab.wait_for(lambda: len(tab.loop.commands) == 1)
    goal = replace(button("t1", GoalPose), asks=True)
    tab.loop.show(tools=(goal,), settings=Settings(fixed_frame="map"))
    card = tab.page.get_by_role("group", name="Send this?")
    for answer, count in (("Cancel", 1), ("Send", 2)):
        tab.wait_for(lambda: tab.page.evaluate(ASKS))
        tab.button("Send again").first.click()
        tab.wait_for(card.is_visible)
        assert len(tab.loop.commands) == 1
        card.get_by_role("button", name=answer).click()
        assert card.count() == 0
        tab.wait_for(lambda count=count: len(tab.loop.commands) == count)
    refused = replace(goal, refusal="No goals today.")
    tab.loop.show(tools=(refused,), settings=Settings(fixed_frame="map"))
    tab.wait_for(lambda: tab.page.locator(".wv-tools [aria-disabled]").count() == 1)
    tab.button("Send again").first.click()
    tab.wait_for(lambda: "No goals today." in tab.page.locator(".wv-hint").inner_text())
    assert len(tab.loop.commands) == 2


def test_what_was_sent_is_listed_sent_again_and_copied(tab: Tab) -> None:
    shown(tab)
    tab.page.evaluate(SEND)
    tab.wait_for(lambda: isinstance((tab.loop.commands or [None])[-1], UseTool))
    command = tab.loop.commands[-1]
    assert isinstance(command, UseTool)
    assert (command.tool, command.points) == ("t1", ((1.0, 2.0, 0.5),))
    position = {"x": 1.0, "y": 2.0, "z": 0.5}
    values = {"header": {"frame_id": "map"}, "pose": {"position": position}}
    command.published("/goal_pose", "geometry_msgs/msg/PoseStamped", values)
    command.report(Status(Level.OK, "Published to /goal_pose, 1 subscription."))
    rows = tab.page.locator(".wv-sent > li")
    tab.wait_for(lambda: "Published to /goal_pose, 1 subscription." in rows.first.inner_text())
    assert "x 1.00 y 2.00 z 0.50 · yaw 90.0° · map" in rows.first.inner_text()
    tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    tab.button("Copy as YAML").click()
    tab.wait_for(lambda: "Copied as YAML." in tab.text())
    assert tab.page.evaluate("navigator.clipboard.readText()") == (
        "# /goal_pose: geometry_msgs/msg/PoseStamped\n"
        "header:\n  frame_id: map\n"
        "pose:\n  position:\n    x: 1\n    y: 2\n    z: 0.5\n"
    )
    tab.button("Send again").first.click()
    tab.wait_for(lambda: len(tab.loop.commands) == 2)
    again = tab.loop.commands[-1]
    assert isinstance(again, UseTool)
    assert (again.points, again.yaw) == (command.points, command.yaw)
    # What was in another frame would be somewhere else.
    tab.loop.show(tools=tab.loop.state.tools, settings=Settings(fixed_frame="odom"))
    tab.turn()
    tab.button("Send again").first.click()
    tab.wait_for(lambda: "Not sent: this was in map." in tab.text())
    for _ in range(25):
        tab.page.evaluate(SEND)
    tab.wait_for(lambda: rows.count() == 20)


def test_a_flood_of_gestures_is_refused_and_hidden_commands_are_unknown(tab: Tab) -> None:
    shown(tab)
    tab.page.evaluate(f"async () => {{ for (let i = 0; i < 200; i++) await ({SEND})(); }}")
    text = "Not sent: more than 20 gestures within a second. Wait a moment."
    tab.wait_for(lambda: text in tab.text())
    tab.page.evaluate(
        "async () => { const { act } = await import('webviz/act.js');"
        "act('ReloadPlugin', { path: 'a.py' }); }"
    )
    tab.wait_for(lambda: "this page is out of date" in tab.text())
    assert len(tab.loop.commands) < 200
