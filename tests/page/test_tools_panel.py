"""The panel "Tools": what was sent, and the properties of the tools."""

from __future__ import annotations

from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.api.tool import Tool
from webviz.commands import SetFixedFrame, SetToolProperty, UseTool
from webviz.tools.goal_pose import GoalPose
from webviz.tools.pose_estimate import PoseEstimate

SEND = """async (id) => {
  const history = await import("webviz/features/tools/history.js");
  const goal = { id, name: "2D Goal Pose", gesture: "pose" };
  history.send(goal, { points: [[1, 2, 0.5]], yaw: Math.PI / 2, keys: [] });
}"""

ASKS = """async () => (await import("webviz/tools/registry.js")).all().some(({ asks }) => asks)"""


def show_tools(viewer: PageBench, tab: ViewerTab) -> tuple[str, str]:
    """Open the panel with two tools; return their ids."""
    tools = [GoalPose(name="2D Goal Pose"), PoseEstimate(name="2D Pose Estimate")]
    viewer.show(tools=tools, publish=("/goal_pose", "/initialpose"))
    tab.show_tab("Tools")
    goal, estimate = viewer.states[-1].tools
    return goal.id, estimate.id


def tool(viewer: PageBench, id_: str) -> Tool:
    """The tool with this id."""
    return next(each.tool for each in viewer.states[-1].tools if each.id == id_)


def test_each_tool_has_its_properties(viewer: PageBench, viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    _, estimate = show_tools(viewer, tab)
    field = tab.page.locator("[data-path='covariance_yaw'] input")
    tab.wait_for(field.is_visible)
    field.fill("0.5")
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(SetToolProperty(estimate, "covariance_yaw", 0.5))
    changed = tool(viewer, estimate)
    assert isinstance(changed, PoseEstimate)
    assert changed.covariance_yaw == 0.5
    topics = tab.page.locator("[data-path='topic.name'] input")
    assert [topic.input_value() for topic in topics.all()] == ["/goal_pose", "/initialpose"]


def test_a_tool_that_asks_asks_again(viewer: PageBench, viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    goal, _ = show_tools(viewer, tab)
    tab.page.evaluate(SEND, goal)
    tab.wait_for(lambda: len(viewer.published()) == 1)
    viewer.do(SetToolProperty(goal, "confirm", True))
    card = tab.page.get_by_role("group", name="Send this?")
    for answer, count in (("Cancel", 1), ("Send", 2)):
        tab.wait_for(lambda: tab.page.evaluate(ASKS))
        tab.button("Send again").first.click()
        tab.wait_for(card.is_visible)
        assert len(viewer.published()) == 1
        card.get_by_role("button", name=answer).click()
        assert card.count() == 0
        tab.wait_for(lambda count=count: len(viewer.published()) == count)
    viewer.do(SetToolProperty(goal, "topic.name", "/elsewhere"))
    tab.wait_for(lambda: tab.page.locator(".wv-tools [aria-disabled]").count() == 1)
    tab.button("Send again").first.click()
    hint, refusal = tab.page.locator(".wv-hint"), viewer.states[-1].tools[0].refusal
    assert "/elsewhere" in refusal
    tab.wait_for(lambda: refusal in hint.inner_text())
    assert len(viewer.published()) == 2


def test_what_was_sent_is_listed_sent_again_and_copied(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    goal, _ = show_tools(viewer, tab)
    tab.page.evaluate(SEND, goal)
    tab.wait_for(lambda: len(viewer.published()) == 1)
    ((topic, message),) = viewer.published()
    position = message.pose.position
    assert (topic, message.header.frame_id) == ("/goal_pose", "map")
    assert (position.x, position.y, position.z) == (1.0, 2.0, 0.5)
    rows = tab.page.locator(".wv-sent > li")
    tab.wait_for(lambda: "Published to /goal_pose, 1 subscription." in rows.first.inner_text())
    assert "x 1.00 y 2.00 z 0.50 · yaw 90.0° · map" in rows.first.inner_text()
    tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    rows.first.get_by_role("button", name="Copy as YAML").click()
    tab.wait_for(lambda: "Copied as YAML." in tab.text())
    assert tab.page.evaluate("navigator.clipboard.readText()") == (
        "# /goal_pose: geometry_msgs/msg/PoseStamped\n"
        "header:\n  stamp:\n    sec: 100\n    nanosec: 0\n  frame_id: map\n"
        "pose:\n  position:\n    x: 1\n    y: 2\n    z: 0.5\n"
        "  orientation:\n    z: 0.7071067811865475\n    w: 0.7071067811865476\n"
    )
    tab.button("Send again").first.click()
    tab.wait_for(lambda: len(viewer.published()) == 2)
    first, again = viewer.commands
    assert isinstance(first, UseTool)
    assert isinstance(again, UseTool)
    assert (again.tool, again.points, again.yaw) == (goal, first.points, first.yaw)
    # What was in another frame would be somewhere else.
    viewer.do(SetFixedFrame("odom"))
    tab.turn()
    tab.button("Send again").first.click()
    tab.wait_for(lambda: "Not sent: this was in map." in tab.text())
    assert len(viewer.published()) == 2
    for _ in range(25):
        tab.page.evaluate(SEND, goal)
    tab.wait_for(lambda: rows.count() == 20)


def test_a_flood_of_gestures_is_refused_and_hidden_commands_are_unknown(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    goal, _ = show_tools(viewer, tab)
    send_all = f"async (id) => {{ for (let i = 0; i < 200; i++) await ({SEND})(id); }}"
    tab.page.evaluate(send_all, goal)
    text = "Not sent: more than 20 gestures within a second. Wait a moment."
    tab.wait_for(lambda: text in tab.text())
    tab.page.evaluate(
        "async () => { const { act } = await import('webviz/act.js');"
        "act('ReloadPlugin', { path: 'a.py' }); }"
    )
    tab.wait_for(lambda: "this page is out of date" in tab.text())
    assert 0 < len(viewer.published()) < 200
