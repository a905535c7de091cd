"""Tools at work in a real browser, with a source whose graph remembers what is published."""

from __future__ import annotations

import math
from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest
from remembering_graph import RememberingGraph

import webviz
from webviz.engine.sources import Outlet
from webviz.files.config import Config
from webviz.files.opening import parse
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.source import HandFedSource

SCALE = 50.0
"""Pixels of a metre."""
CONFIG = "fixed_frame: map\nview: {type: TopDownOrtho, scale: 50}\ndisplays: [{type: Grid}]\n"


@pytest.fixture(scope="module")
def source() -> HandFedSource:
    return HandFedSource()


@pytest.fixture(scope="module")
def viewer(source: HandFedSource) -> Iterator[webviz.Viewer]:
    def read(_: object) -> Config:
        return parse(CONFIG, "x.yaml")

    with webviz.Viewer(port=0, source=source, read=read) as viewer:
        yield viewer


@pytest.fixture
def graph(source: HandFedSource) -> RememberingGraph:
    graph = RememberingGraph()
    source.graph = graph  # pyright: ignore[reportAttributeAccessIssue]  # nothing calls services here
    return graph


@pytest.fixture(scope="module")
def pages(browser: playwright.Browser, viewer: webviz.Viewer) -> Iterator[list[Page]]:
    opened = [Page(browser, viewer.url, 900, 600) for _ in range(2)]
    yield opened
    errors = [error for page in opened for error in page.errors]
    for page in opened:
        page.close()
    assert errors == []


@pytest.fixture
def page(pages: list[Page], viewer: webviz.Viewer) -> Page:
    viewer.view = {"type": "TopDownOrtho", "scale": SCALE}
    tab = pages[0].tab
    pages[0].wait_for(lambda: tab.locator(".wv-tools button").count() == 1, "the toolbar")
    pages[0].draw()
    if is_active(pages[0]):
        tab.keyboard.press("Escape")
    return pages[0]


def is_active(page: Page) -> bool:
    return page.tab.locator(".wv-tools button[aria-pressed=true]").count() == 1


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
    ((outlet, goal),) = graph.published
    assert outlet == Outlet("/goal_pose", "geometry_msgs/msg/PoseStamped")
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


def test_a_click_keeps_the_heading_of_the_stroke_before(
    page: Page, graph: RememberingGraph
) -> None:
    for end in ((60.0, 60.0), (0.0, 0.0)):
        page.tab.keyboard.press("g")
        drag(page, (0.0, 0.0), end)
    page.wait_for(lambda: len(graph.published) == 2, "two goals")
    first, second = (goal.pose.orientation for _, goal in graph.published)
    assert (second.z, second.w) == (first.z, first.w)
    assert 2.0 * math.atan2(first.z, first.w) == pytest.approx(-math.pi / 4, abs=0.02)


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
    preview = page.tab.locator("svg[data-webviz=preview]")
    page.wait_for(lambda: preview.count() == 1, "the preview")
    assert page.tab.evaluate(camera) == before
    page.tab.keyboard.press("Escape")
    assert preview.count() == 0
    assert not is_active(page)
    page.tab.mouse.up()
    page.draw()
    assert graph.published == []


@pytest.mark.parametrize("back", ["g", "Escape"])
def test_the_key_and_escape_go_back(page: Page, graph: RememberingGraph, back: str) -> None:
    page.tab.keyboard.press("g")
    assert is_active(page)
    page.tab.keyboard.press(back)
    assert not is_active(page)


def test_the_button_selects_the_tool_in_its_own_browser_only(
    page: Page, pages: list[Page], graph: RememberingGraph
) -> None:
    page.tab.get_by_role("button", name="2D Goal Pose").click()
    assert is_active(page)
    assert not is_active(pages[1])
    drag(page, (0.0, 0.0), (50.0, 0.0))
    page.wait_for(lambda: answer(page).startswith("Published"), "the answer")
    assert answer(pages[1]) == ""


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


@pytest.mark.parametrize(
    "stroke",
    [
        '{"type":"StrokeDone","tool":"TOOL","points":[[1e308,0,0]],"yaw":0,"keys":[]}',
        '{"type":"StrokeDone","tool":"TOOL","points":[],"yaw":0,"keys":[]}',
        '{"type":"StrokeDone","tool":"no tool","points":[[0,0,0]],"yaw":0,"keys":[]}',
        '{"type":"StrokeDone","tool":"TOOL","points":[[null,0,0]],"yaw":0,"keys":[]}',
        '{"type":"StrokeDone","tool":"TOOL","points":[[0,0,0]],"yaw":1e308,"keys":[]}',
        '{"type":"StrokeDone","tool":5}',
    ],
)
def test_a_stroke_that_is_not_valid_publishes_nothing(
    page: Page, graph: RememberingGraph, viewer: webviz.Viewer, stroke: str
) -> None:
    text = stroke.replace("TOOL", viewer.state.tools[0].id)
    page.tab.evaluate(
        "async (text) => (await import('./webviz/channel.js')).send(JSON.parse(text))", text
    )
    drag_works(page, graph)


def drag_works(page: Page, graph: RememberingGraph) -> None:
    page.tab.keyboard.press("g")
    drag(page, (0.0, 0.0), (50.0, 0.0))
    page.wait_for(lambda: len(graph.published) > 0, "a goal")
    assert len(graph.published) == 1


def test_a_source_that_only_reads_says_so(
    page: Page, source: HandFedSource, graph: RememberingGraph
) -> None:
    source.graph = HandFedSource().graph
    page.tab.keyboard.press("g")
    drag(page, (0.0, 0.0), (50.0, 0.0))
    page.wait_for(lambda: answer(page) == "This source can only be read.", "the reason")


def test_a_program_uses_a_tool_as_a_page_does(
    viewer: webviz.Viewer, graph: RememberingGraph
) -> None:
    said = viewer.tool("2D Goal Pose").send(1.0, 2.0, math.pi)
    assert said == "Published to /goal_pose, 1 subscription."
    ((_, goal),) = graph.published
    assert (goal.pose.position.x, goal.pose.position.y, goal.pose.orientation.z) == (1.0, 2.0, 1.0)
    with pytest.raises(webviz.Error, match=r"Unknown tool `2D Gaol Pose`: did you mean"):
        viewer.tool("2D Gaol Pose").send(0.0, 0.0)
    with pytest.raises(webviz.Error, match="a stroke has 1 to 1000 points within"):
        viewer.tool("2D Goal Pose").send(math.nan, 0.0)
