"""Tools at work in a real browser, with a source whose graph remembers what is published."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import playwright.sync_api as playwright
import pytest
from pages import open_pages

import webviz
from webviz.commands import SetToolProperty, ShowView
from webviz.files.opening import parse
from webviz.shell.app.picture_controls import checked_view
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import HandFedSource
from webviz.sources import Advertisement

SCALE = 50.0
"""Pixels of a metre."""
CONFIG = "fixed_frame: map\nview: {type: TopDownOrtho, scale: 50}\ndisplays: [{type: Grid}]\n"


@pytest.fixture(scope="module")
def source() -> HandFedSource:
    return HandFedSource(graph=RememberingGraph())  # pyright: ignore[reportArgumentType]


@pytest.fixture(scope="module")
def viewer(source: HandFedSource) -> Iterator[webviz.Viewer]:
    with webviz.Viewer(port=0, source=source, read=lambda *_: parse(CONFIG, "x.yaml")) as viewer:
        yield viewer


@pytest.fixture
def graph(source: HandFedSource) -> RememberingGraph:
    graph = RememberingGraph()
    source.graph = graph  # pyright: ignore[reportAttributeAccessIssue]  # nothing calls services here
    return graph


ACTIVE = ".wv-tools button[aria-pressed=true]"


@pytest.fixture(scope="module")
def lasting_page(browser: playwright.Browser, viewer: webviz.Viewer) -> Iterator[Page]:
    with open_pages(browser, viewer.url, 900, 600, count=1) as (lasting_page,):
        yield lasting_page


@pytest.fixture
def page(lasting_page: Page, viewer: webviz.Viewer) -> Page:
    show(viewer, {"type": "TopDownOrtho", "scale": SCALE})
    tab = lasting_page.tab
    tab.locator(".wv-first-run, .wv-toast").evaluate_all(
        "(all) => all.forEach((one) => one.remove())"
    )
    lasting_page.wait_for(lambda: tab.locator(".wv-tools button").count() == 10, "the toolbar")
    lasting_page.draw()
    tab.keyboard.press("Escape")
    return lasting_page


def show(viewer: webviz.Viewer, view: dict[str, Any]) -> None:
    """Show a view without changing the default one, which toasts over the scene would tell."""
    viewer.do(ShowView(checked_view(view)))


def is_active(page: Page) -> bool:
    """Return whether another tool than the default one is selected."""
    return active(page) != "Interact"


def active(page: Page) -> str:
    return page.tab.locator(ACTIVE).get_attribute("aria-label") or ""


def answer(page: Page) -> str:
    return page.tab.locator(".wv-hint").inner_text()


def middle(page: Page) -> tuple[float, float]:
    box = page.tab.evaluate(
        "(() => { const b = window.__viserMutable.canvas.getBoundingClientRect();"
        "return [b.left + b.width / 2, b.top + b.height / 2]; })()"
    )
    return box[0], box[1]


def drag(page: Page, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Press at a place and let go at another, in pixels from the middle of the scene."""
    x, y = middle(page)
    mouse = page.tab.mouse
    mouse.move(x + start[0], y + start[1])
    mouse.down()
    mouse.move(x + end[0], y + end[1], steps=4)
    mouse.up()


def test_a_drag_publishes_the_pose_under_the_pointer(
    page: Page, graph: RememberingGraph, source: HandFedSource
) -> None:
    source.now = 12_000_000_345
    page.tab.keyboard.press("g")
    assert is_active(page)
    drag(page, (100.0, -50.0), (100.0, -150.0))
    page.wait_for(lambda: answer(page) == "Published to /goal_pose, 1 subscription.", "the answer")
    ((advertisement, goal),) = graph.published
    assert advertisement == Advertisement("/goal_pose", "geometry_msgs/msg/PoseStamped")
    assert (goal.header.frame_id, goal.header.stamp.sec, goal.header.stamp.nanosec) == (
        "map",
        12,
        345,
    )
    # Up on the screen is +y, right is +x: to the pixel.
    assert goal.pose.position.x == pytest.approx(100.0 / SCALE, abs=0.5 / SCALE)
    assert goal.pose.position.y == pytest.approx(50.0 / SCALE, abs=0.5 / SCALE)
    assert goal.pose.position.z == 0.0
    yaw = 2.0 * math.atan2(goal.pose.orientation.z, goal.pose.orientation.w)
    assert yaw == pytest.approx(math.pi / 2, abs=0.01)
    assert not is_active(page)


def test_a_click_without_a_drag_keeps_no_old_heading(page: Page, graph: RememberingGraph) -> None:
    for end in ((60.0, 60.0), (0.0, 0.0)):
        page.tab.keyboard.press("g")
        drag(page, (0.0, 0.0), end)
    page.wait_for(lambda: len(graph.published) == 2, "two goals")
    first, second = (goal.pose.orientation for _, goal in graph.published)
    assert 2.0 * math.atan2(first.z, first.w) == pytest.approx(-math.pi / 4, abs=0.02)
    assert (second.z, second.w) == (0.0, 1.0)


@pytest.mark.parametrize(("key", "topic"), [("g", "/goal_pose"), ("p", "/initialpose")])
def test_ctrl_lifts_a_pose_and_the_hint_gives_its_position(
    page: Page, graph: RememberingGraph, viewer: webviz.Viewer, key: str, topic: str
) -> None:
    show(viewer, {"type": "Orbit", "distance": 10.0, "yaw": -1.570796, "pitch": 0.5})
    page.draw()
    tab, (x, y) = page.tab, middle(page)
    tab.keyboard.press(key)
    tab.mouse.move(x, y + 40)
    tab.mouse.down()
    tab.mouse.move(x + 80, y + 40, steps=3)
    assert answer(page).endswith("z 0.00 m · yaw 0.0°")
    tab.keyboard.down("Control")
    tab.mouse.move(x + 80, y - 40, steps=3)
    lifted = answer(page)
    tab.keyboard.up("Control")
    tab.mouse.move(x + 80, y - 45)
    tab.mouse.up()
    page.wait_for(lambda: answer(page) == f"Published to {topic}, 1 subscription.", "the answer")
    ((_, message),) = graph.published
    pose = message.pose.pose if topic == "/initialpose" else message.pose
    assert f"x {pose.position.x:.2f} y {pose.position.y:.2f} z {pose.position.z:.2f} m" in lifted
    # 80 pixels at 10 m from the camera, which looks down by half a radian.
    assert 0.8 < pose.position.z < 2.0
    assert pose.orientation.w == pytest.approx(1.0, abs=0.02)


def test_seen_from_above_a_pixel_up_lifts_by_a_pixel(page: Page, graph: RememberingGraph) -> None:
    tab, (x, y) = page.tab, middle(page)
    tab.keyboard.press("g")
    tab.mouse.move(x + 50, y)
    tab.keyboard.down("Control")
    tab.mouse.down()
    tab.mouse.move(x + 50, y - 100, steps=3)
    tab.mouse.up()
    tab.keyboard.up("Control")
    page.wait_for(lambda: len(graph.published) == 1, "the goal")
    ((_, goal),) = graph.published
    position = goal.pose.position
    expected = pytest.approx((50.0 / SCALE, 0.0, 100.0 / SCALE), abs=0.5 / SCALE)
    assert (position.x, position.y, position.z) == expected


HEIGHT = """async (xy) => {
  const { surfaceAt } = await import("webviz/scene/ground.js");
  return surfaceAt(xy)[2];
}"""
STAYS = """async (name) => {
  const { all } = await import("webviz/tools/registry.js");
  return all().find((tool) => tool.name === name).stays;
}"""


@pytest.fixture
def box(viewer: webviz.Viewer, page: Page) -> Iterator[None]:
    """Axes whose x axis, a rod with a radius of 1 m, lies on the ground."""
    axes = viewer.add("Axes", length=4.0, radius=1.0)
    x, y = middle(page)
    page.wait_for(lambda: page.evaluate(HEIGHT, [x + 2 * SCALE, y]) > 0.9, "the rod")
    yield
    axes.remove()


def test_a_point_is_published_with_its_true_height(
    page: Page, graph: RememberingGraph, box: None
) -> None:
    page.tab.keyboard.press("u")
    drag(page, (2.0 * SCALE, 0.0), (2.0 * SCALE, 0.0))
    page.wait_for(lambda: len(graph.published) == 1, "the point")
    ((advertisement, point),) = graph.published
    assert advertisement == Advertisement("/clicked_point", "geometry_msgs/msg/PointStamped")
    expected = pytest.approx((2.0, 0.0, 1.0), abs=0.05)
    assert (point.point.x, point.point.y, point.point.z) == expected
    assert not is_active(page)


def test_points_follow_each_other_without_single_click(
    page: Page, graph: RememberingGraph, viewer: webviz.Viewer
) -> None:
    viewer.do(SetToolProperty("Publish Point", "single_click", False))
    page.wait_for(lambda: page.evaluate(STAYS, "Publish Point"), "the changed tool")
    page.tab.keyboard.press("u")
    for x in (0.0, 50.0):
        drag(page, (x, 0.0), (x, 0.0))
    page.wait_for(lambda: len(graph.published) == 2, "two points")
    assert active(page) == "Publish Point"
    viewer.do(SetToolProperty("Publish Point", "single_click", True))
    page.wait_for(lambda: not page.evaluate(STAYS, "Publish Point"), "the tool as before")


def test_a_gesture_continues_when_its_tool_changes(
    page: Page, graph: RememberingGraph, viewer: webviz.Viewer
) -> None:
    page.tab.keyboard.press("u")
    x, y = middle(page)
    page.tab.mouse.move(x, y)
    page.tab.mouse.down()
    viewer.do(SetToolProperty("Publish Point", "single_click", False))
    page.wait_for(lambda: page.evaluate(STAYS, "Publish Point"), "the changed tool")
    page.tab.mouse.up()
    page.wait_for(lambda: len(graph.published) == 1, "the point")
    assert active(page) == "Publish Point"
    viewer.do(SetToolProperty("Publish Point", "single_click", True))
    page.wait_for(lambda: not page.evaluate(STAYS, "Publish Point"), "the tool as before")


def test_a_pose_estimate_is_published_by_a_drag(page: Page, graph: RememberingGraph) -> None:
    page.tab.keyboard.press("p")
    drag(page, (0.0, 50.0), (-50.0, 50.0))
    page.wait_for(lambda: len(graph.published) == 1, "the estimate")
    ((advertisement, estimate),) = graph.published
    assert advertisement.topic == "/initialpose"
    assert estimate.pose.pose.position.y == pytest.approx(-1.0, abs=0.5 / SCALE)
    assert abs(estimate.pose.pose.orientation.z) == pytest.approx(1.0, abs=1e-3)
    assert estimate.pose.covariance[35] == pytest.approx((math.pi / 12) ** 2)


def test_measuring_shows_the_length_until_it_is_cleared(
    page: Page, graph: RememberingGraph, viewer: webviz.Viewer
) -> None:
    tab, (x, y) = page.tab, middle(page)
    labels = tab.locator(".wv-measure-label:visible")
    tab.keyboard.press("n")
    tab.mouse.click(x, y)
    tab.mouse.move(x + 50, y, steps=3)
    page.wait_for(lambda: "1.000 m" in answer(page), "the live length")
    tab.mouse.click(x - 150, y + 200)
    tab.mouse.click(x - 50, y)
    tab.mouse.click(x - 100, y)
    page.draw()
    assert labels.all_inner_texts() == [
        "5.000 m\nx -3.000 y -4.000 z 0.000",
        "1.000 m\nx -1.000 y 0.000 z 0.000",
    ]
    tab.context.grant_permissions(["clipboard-read", "clipboard-write"])
    labels.first.click()
    page.wait_for(lambda: answer(page).startswith("Copied 5.000 m (x -3.000"), "the answer")
    assert tab.evaluate("navigator.clipboard.readText()") == "5.000 m (x -3.000 y -4.000 z 0.000)"
    tab.keyboard.press("Escape")
    assert labels.count() == 2
    # It stays where it is in the fixed frame.
    before = labels.first.bounding_box()
    show(viewer, {"type": "TopDownOrtho", "scale": 2 * SCALE})
    page.draw()
    after = labels.first.bounding_box()
    assert before
    assert after
    assert after["x"] - before["x"] == pytest.approx(-75.0, abs=2.0)
    tab.keyboard.press("n")
    tab.mouse.click(x, y, button="right")
    page.wait_for(lambda: labels.count() == 0, "no lines")


def test_measuring_snaps_to_surfaces(page: Page, graph: RememberingGraph, box: None) -> None:
    tab, (x, y) = page.tab, middle(page)
    tab.keyboard.press("n")
    tab.mouse.click(x + 2 * SCALE, y)
    tab.mouse.click(x - 3 * SCALE, y - 2 * SCALE)
    page.draw()
    text = tab.locator(".wv-measure-label").inner_text()
    tab.mouse.click(x, y, button="right")
    dx, dy, dz = (float(word) for word in text.split("\n")[1].split()[1::2])
    assert (dx, dy, dz) == pytest.approx((-5.0, 2.0, -1.0), abs=0.05)


def test_focus_camera_looks_at_the_point(page: Page, graph: RememberingGraph) -> None:
    page.tab.keyboard.press("c")
    assert active(page) == "Focus Camera"
    drag(page, (2.0 * SCALE, SCALE), (2.0 * SCALE, SCALE))
    assert not is_active(page)
    page.draw()
    page.tab.keyboard.press("g")
    drag(page, (0.0, 0.0), (0.0, 0.0))
    page.wait_for(lambda: len(graph.published) == 1, "the goal")
    ((_, goal),) = graph.published
    expected = pytest.approx((2.0, -1.0), abs=1.0 / SCALE)
    assert (goal.pose.position.x, goal.pose.position.y) == expected


@pytest.mark.parametrize("key", ["i", "m", "n", "c"])
def test_the_camera_is_dragged_with_tools_of_the_page(
    page: Page, graph: RememberingGraph, viewer: webviz.Viewer, key: str
) -> None:
    show(viewer, {"type": "Orbit", "distance": 10.0})
    page.draw()
    camera = "window.__viserMutable.camera.matrixWorld.toArray().join()"
    before = page.tab.evaluate(camera)
    page.tab.keyboard.press(key)
    drag(page, (0.0, 0.0), (60.0, 0.0))
    page.draw()
    assert page.tab.evaluate(camera) != before
    assert page.tab.locator(".wv-measure-label").count() == 0


def test_the_camera_stays_and_the_preview_is_there_during_the_drag(
    page: Page, graph: RememberingGraph
) -> None:
    camera = "window.__viserMutable.camera.matrixWorld.toArray().join()"
    before = page.tab.evaluate(camera)
    page.tab.keyboard.press("g")
    x, y = middle(page)
    page.tab.mouse.move(x, y)
    page.tab.mouse.down()
    page.tab.mouse.move(x + 80, y, steps=4)
    page.tab.mouse.wheel(0, 300)
    preview = page.tab.locator("[data-webviz=preview]")
    page.wait_for(lambda: preview.count() == 1, "the preview")
    assert page.tab.evaluate(camera) == before
    page.tab.keyboard.press("Escape")
    assert preview.count() == 0
    assert not is_active(page)
    page.tab.mouse.up()
    page.draw()
    assert graph.published == []


KEYS = {
    "m": "Move Camera",
    "c": "Focus Camera",
    "n": "Measure",
    "p": "2D Pose Estimate",
    "g": "2D Goal Pose",
    "u": "Publish Point",
}


def test_the_keys_are_those_of_rviz_and_themselves_or_escape_go_back(page: Page) -> None:
    for key, name in KEYS.items():
        for back in (key, "Escape", "i"):
            page.tab.keyboard.press(key)
            assert active(page) == name
            page.tab.keyboard.press(back)
            assert not is_active(page)


def test_the_tools_have_the_order_of_rviz(page: Page) -> None:
    buttons = page.tab.locator(".wv-tools button")
    labels = buttons.evaluate_all("(all) => all.map((one) => one.ariaLabel)")
    assert [label for label in labels if label in KEYS.values()] == list(KEYS.values())


def test_a_tool_with_confirm_sends_nothing_before_confirmation(
    page: Page, graph: RememberingGraph, viewer: webviz.Viewer
) -> None:
    tab, card = page.tab, page.tab.get_by_role("group", name="Send this?")
    preview = tab.locator("[data-webviz=preview]")
    knows = "async () => (await import('webviz/tools/registry.js')).all().some((one) => one.asks)"
    viewer.do(SetToolProperty("2D Goal Pose", "confirm", True))
    page.wait_for(lambda: tab.evaluate(knows), "the tool that asks")

    def ask(x: float) -> None:
        drag(page, (x, 0.0), (x, -60.0))
        assert card.is_visible()
        assert "Enter sends, Esc cancels." in answer(page)
        assert graph.published == []

    tab.keyboard.press("g")
    ask(0.0)
    tab.keyboard.press("Escape")
    assert preview.count() == 0
    assert not is_active(page)
    tab.keyboard.press("g")
    ask(0.0)
    card.get_by_role("button", name="Cancel").click()
    assert preview.count() == 0
    assert active(page) == "2D Goal Pose"
    # Another gesture replaces the one that waits. Meanwhile the camera can be moved.
    ask(50.0)
    ask(-50.0)
    assert preview.count() == 1
    tab.mouse.wheel(0, 1)
    tab.keyboard.press("Enter")
    page.wait_for(lambda: len(graph.published) == 1, "the goal")
    ((_, goal),) = graph.published
    assert goal.pose.position.x == pytest.approx(-1.0, abs=0.5 / SCALE)
    assert preview.count() == 0
    assert not is_active(page)
    viewer.do(SetToolProperty("2D Goal Pose", "confirm", False))
    page.wait_for(lambda: not tab.evaluate(knows), "the tool that sends")


def test_the_button_selects_the_tool(page: Page, graph: RememberingGraph) -> None:
    page.tab.get_by_role("button", name="2D Goal Pose").click()
    assert is_active(page)
    drag(page, (0.0, 0.0), (50.0, 0.0))
    page.wait_for(lambda: answer(page).startswith("Published"), "the answer")


def test_a_missing_subscription_is_reported(page: Page, graph: RememberingGraph) -> None:
    graph.subscriptions = 0
    page.tab.keyboard.press("g")
    drag(page, (0.0, 0.0), (50.0, 0.0))
    page.wait_for(lambda: answer(page).startswith("No subscription to /goal_pose. "), "the answer")


def test_touch_makes_a_stroke_as_well(page: Page, graph: RememberingGraph) -> None:
    page.tab.get_by_role("button", name="2D Goal Pose").click()
    x, y = middle(page)
    session = page.tab.context.new_cdp_session(page.tab)

    def touch(kind: str, *points: tuple[float, float]) -> None:
        at = [{"x": px, "y": py} for px, py in points]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": at})

    touch("touchStart", (x, y))
    touch("touchMove", (x + 50.0, y))
    touch("touchEnd")
    page.wait_for(lambda: len(graph.published) == 1, "the goal")
    # A second finger lifts, wherever it is, and the heading stays.
    page.tab.get_by_role("button", name="2D Goal Pose").click()
    touch("touchStart", (x, y))
    touch("touchMove", (x + 50.0, y))
    touch("touchStart", (x + 50.0, y), (x - 90.0, y + 100.0))
    touch("touchMove", (x + 50.0, y), (x - 90.0, y))
    touch("touchEnd")
    page.wait_for(lambda: len(graph.published) == 2, "the lifted goal")
    goal = graph.published[-1][1].pose
    assert goal.position.z == pytest.approx(100.0 / SCALE, abs=1.0 / SCALE)
    assert (goal.position.x, goal.position.y) == pytest.approx((0.0, 0.0), abs=1.0 / SCALE)
    assert goal.orientation.w == pytest.approx(1.0, abs=0.01)


def test_a_pen_makes_a_stroke_as_well(page: Page, graph: RememberingGraph) -> None:
    page.tab.keyboard.press("g")
    x, y = middle(page)
    session = page.tab.context.new_cdp_session(page.tab)
    for kind, dx in (("mousePressed", 0.0), ("mouseMoved", 50.0), ("mouseReleased", 50.0)):
        at = {"x": x + dx, "y": y, "button": "left", "buttons": 1, "clickCount": 1}
        session.send("Input.dispatchMouseEvent", {"type": kind, "pointerType": "pen", **at})
    page.wait_for(lambda: len(graph.published) == 1, "the goal")
    assert graph.published[0][1].pose.orientation.w == pytest.approx(1.0)


@pytest.mark.parametrize(
    "gesture",
    [
        {"tool": "TOOL", "points": [[1e308, 0, 0]], "yaw": 0, "keys": []},
        {"tool": "TOOL", "points": [], "yaw": 0, "keys": []},
        {"tool": "no tool", "points": [[0, 0, 0]], "yaw": 0, "keys": []},
        {"tool": "TOOL", "points": [[None, 0, 0]], "yaw": 0, "keys": []},
        {"tool": "TOOL", "points": [[0, 0, 0]], "yaw": 1e308, "keys": []},
        {"tool": 5},
    ],
)
def test_a_stroke_that_is_not_valid_publishes_nothing(
    page: Page, graph: RememberingGraph, viewer: webviz.Viewer, gesture: dict[str, Any]
) -> None:
    goal = next(tool for tool in viewer.state.tools if tool.name == "2D Goal Pose")
    if gesture["tool"] == "TOOL":
        gesture = {**gesture, "tool": goal.id}
    send = "async (gesture) => void (await import('webviz/act.js')).send('UseTool', gesture)"
    page.tab.evaluate(send, gesture)
    drag_works(page, graph)


def drag_works(page: Page, graph: RememberingGraph) -> None:
    page.tab.keyboard.press("g")
    drag(page, (0.0, 0.0), (50.0, 0.0))
    page.wait_for(lambda: len(graph.published) > 0, "a goal")
    assert len(graph.published) == 1


def test_tools_of_a_read_only_source_are_disabled_with_the_reason(
    page: Page, source: HandFedSource, graph: RememberingGraph
) -> None:
    reason = "This source can only be read."
    disabled = page.tab.locator(".wv-tools [aria-disabled=true]")
    page.tab.keyboard.press("g")
    source.graph = HandFedSource().graph
    # The tool that is active is left, and none of them can be chosen.
    page.wait_for(lambda: answer(page) == reason, "the reason")
    assert not is_active(page)
    tips = disabled.evaluate_all("(all) => all.map((one) => one.dataset.tip)")
    assert f"2D Goal Pose: {reason}" in tips
    page.tab.evaluate("async () => (await import('webviz/tools/hint.js')).showHint('hint', '')")
    page.tab.keyboard.press("g")
    assert answer(page) == reason
    assert not is_active(page)
    source.graph = graph  # pyright: ignore[reportAttributeAccessIssue]
    page.wait_for(lambda: disabled.count() == 0, "the tools")


def test_a_program_uses_a_tool_as_a_page_does(
    viewer: webviz.Viewer, graph: RememberingGraph
) -> None:
    text = viewer.tool("2D Goal Pose").send(1.0, 2.0, math.pi)
    assert text == "Published to /goal_pose, 1 subscription."
    ((_, goal),) = graph.published
    assert (goal.pose.position.x, goal.pose.position.y, goal.pose.orientation.z) == (1.0, 2.0, 1.0)
    viewer.tool("2D Pose Estimate").send(3.0, 4.0)
    viewer.tool("Publish Point").send(5.0, 6.0, z=7.0)
    (_, estimate), (_, point) = graph.published[1:]
    assert estimate.pose.pose.position.y == 4.0
    assert (point.point.x, point.point.y, point.point.z) == (5.0, 6.0, 7.0)
    with pytest.raises(webviz.Error, match=r"Unknown tool `2D Gaol Pose`: did you mean"):
        viewer.tool("2D Gaol Pose").send(0.0, 0.0)
    with pytest.raises(webviz.Error, match="a gesture has 1 to 1000 points within"):
        viewer.tool("2D Goal Pose").send(math.nan, 0.0)
