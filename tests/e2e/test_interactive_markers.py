"""Interactive markers in two browsers, moved with a real mouse, on a server over DDS."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Sequence
from typing import Any

import playwright.sync_api as playwright
import pytest
from pages import open_pages

import webviz
from webviz.commands import ShowView
from webviz.files.config import Config
from webviz.files.opening import parse
from webviz.shell.app.picture_controls import checked_view
from webviz.shell.pictures.browser import Page

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from basic_controls import basic_controls
from geometry_msgs.msg import Pose
from marker_server import Feedback, MarkerServer
from visualization_msgs.msg import MenuEntry

from webviz.ros.node import RosSource

RESOLUTION = 0.2
"""Pixels of the scene per pixel of the page."""
KEEP_ALIVE, UPDATE, MENU, CLICK, DOWN, UP = range(6)
NAMESPACE = "/basic_controls"
CONFIG = f"""\
fixed_frame: base_link
displays:
- {{type: Grid}}
- {{type: InteractiveMarkers, interactive_markers_namespace: {NAMESPACE}}}
"""


@pytest.fixture(scope="module")
def server(ros_env: dict[str, str]) -> Iterator[MarkerServer]:
    server = MarkerServer(NAMESPACE, int(ros_env["ROS_DOMAIN_ID"]), basic_controls())
    server.transform("base_link", "moving_frame", 0.5, 0.0, 0.0)
    yield server
    server.close()


@pytest.fixture(scope="module")
def viewer(ros_env: dict[str, str]) -> Iterator[webviz.Viewer]:
    def read(*_: object) -> Config:
        return parse(CONFIG, "x.yaml")

    source = RosSource(domain_id=int(ros_env["ROS_DOMAIN_ID"]))
    with webviz.Viewer(port=0, source=source, read=read) as viewer:
        yield viewer


@pytest.fixture(scope="module")
def pages(
    browser: playwright.Browser, viewer: webviz.Viewer, server: MarkerServer
) -> Iterator[list[Page]]:
    with open_pages(browser, viewer.url, 900, 700, resolution=RESOLUTION) as open_tabs:
        for page in open_tabs:
            page.wait_for(lambda page=page: len(markers_on_page(page)) == 13, "all markers", 60)
            page.tab.evaluate("document.body.classList.add('wv-folded')")
        yield open_tabs


@pytest.fixture
def page(pages: list[Page], server: MarkerServer) -> Page:
    pages[0].tab.mouse.up()  # of a test that failed
    server.feedback.clear()
    server.callback = lambda feedback: None
    pages[0].tab.mouse.move(450, 695)
    return pages[0]


def markers_on_page(page: Page) -> dict[str, Any]:
    """The handles that a page knows, by the name of their marker."""
    return page.tab.evaluate(
        """async () => {
          const { all } = await import("webviz/features/handles/registry.js");
          return Object.fromEntries([...all()].map(([id, each]) => [each.name, { id, ...each }]));
        }"""
    )


def pose(page: Page, name: str) -> tuple[list[float], list[float]]:
    """Return where a page shows a marker in its frame: position and orientation, w first."""
    value = page.tab.evaluate(
        """async (id) => (await import("webviz/features/handles/poses.js")).poseOf(id)""",
        markers_on_page(page)[name]["id"],
    )
    return value["position"], value["wxyz"]


def on_screen(page: Page, point: Sequence[float]) -> tuple[float, float]:
    """Return where a point of the fixed frame is in the window."""
    x, y = page.tab.evaluate(
        """async (point) => {
          const { frameNode, projectionOf } = await import("webviz/scene/projection.js");
          return projectionOf(frameNode("")).project(point);
        }""",
        list(point),
    )
    return x, y


def look_at(page: Page, viewer: webviz.Viewer, x: float, y: float, **view: Any) -> None:
    """Look down at a place, with +x to the right and +y up, 100 pixels a metre."""
    expected = {"type": "TopDownOrtho", "scale": 100.0, "x": x, "y": y, **view}
    viewer.do(ShowView(checked_view(expected)))
    middle = page.evaluate("""() => {
      const { left, top, width, height } = document.querySelector("canvas").getBoundingClientRect();
      return [left + width / 2, top + height / 2];
    }""")

    def is_there() -> bool:
        page.draw()
        return on_screen(page, (x, y, 0.0)) == pytest.approx(middle, abs=1.0)

    page.wait_for(is_there, "the view")


def drag(
    page: Page, start: Sequence[float], end: Sequence[float], button: Any = "left", steps: int = 6
) -> None:
    mouse = page.tab.mouse
    mouse.move(*on_screen(page, start))
    mouse.down(button=button)
    mouse.move(*on_screen(page, end), steps=steps)
    mouse.up(button=button)


def wait_for(page: Page, server: MarkerServer, event: int, count: int = 1) -> list[Feedback]:
    """All feedback, once so many of an event have come."""
    page.wait_for(
        lambda: [each.event_type for each in server.feedback].count(event) >= count,
        f"event {event}",
        60,
    )
    return list(server.feedback)


def test_a_drag_in_a_plane_moves_the_marker_and_reports_every_step(
    page: Page, pages: list[Page], viewer: webviz.Viewer, server: MarkerServer
) -> None:
    """The box snaps to the middle of its square when it is let go, as its server wants it."""

    def snap(feedback: Feedback) -> None:
        if feedback.event_type == UPDATE:
            at, snapped = feedback.pose.position, Pose(orientation=feedback.pose.orientation)
            snapped.position.x = math.floor(at.x) + 0.5
            snapped.position.y = math.floor(at.y) + 0.5
            server.set_pose("chess_piece", snapped)

    server.callback = snap
    look_at(page, viewer, 3.0, -3.0)
    drag(page, (3.0, -3.0, 0.2), (4.2, -2.1, 0.2))
    feedback = wait_for(page, server, UP)
    events = [each.event_type for each in feedback if each.event_type != KEEP_ALIVE]
    assert events[:2] == [UPDATE, DOWN]
    assert set(events[2:-1]) == {UPDATE}
    assert events[-1] == UP
    down, up = feedback[1], feedback[-1]
    assert (up.marker_name, up.control_name) == ("chess_piece", "")
    assert (up.header.frame_id, up.header.stamp.sec) == ("base_link", 0)
    assert (up.pose.position.x, up.pose.position.y) == pytest.approx((4.2, -2.1), abs=0.02)
    assert down.mouse_point_valid
    assert (down.mouse_point.x, down.mouse_point.y) == pytest.approx((3.0, -3.0), abs=0.02)
    assert (up.mouse_point.x, up.mouse_point.y) == pytest.approx((4.2, -2.1), abs=0.02)
    assert up.mouse_point.z == pytest.approx(0.225, abs=0.01)
    assert len({each.client_id for each in feedback}) == 1
    for each in pages:
        each.wait_for(
            lambda each=each: pose(each, "chess_piece")[0][:2] == pytest.approx([4.5, -2.5]),
            "the middle of the square",
        )


def test_a_ring_turns_the_marker_and_an_arrow_moves_it_along_its_axis(
    page: Page, viewer: webviz.Viewer, server: MarkerServer
) -> None:
    look_at(page, viewer, -3.0, -6.0)
    radius = 0.57
    corner = radius * math.sqrt(0.5)
    # not where the other ring of the marker crosses this one
    drag(page, (-3.0 + corner, -6.0 + corner, 0.0), (-3.0, -6.0 + radius, 0.0))
    last = wait_for(page, server, UP)[-1]
    turned = 2.0 * math.atan2(last.pose.orientation.z, last.pose.orientation.w)
    assert turned == pytest.approx(math.pi / 4, abs=0.03)
    assert (last.pose.position.x, last.pose.position.y) == (-3.0, -6.0)

    server.feedback.clear()
    look_at(page, viewer, 0.0, 3.0)
    drag(page, (0.8, 3.0, 0.0), (1.5, 3.4, 0.0))
    last = wait_for(page, server, UP)[-1]
    assert last.control_name == "move_x"
    assert (last.pose.position.x, last.pose.position.y) == pytest.approx((0.7, 3.0), abs=0.02)


def test_boxes_are_moved_along_the_screen_and_turned_like_balls(
    page: Page, viewer: webviz.Viewer, server: MarkerServer
) -> None:
    look_at(page, viewer, 3.0, 3.0)
    drag(page, (3.0, 3.0, 0.2), (3.8, 3.5, 0.2))
    last = wait_for(page, server, UP)[-1]
    assert last.marker_name == "simple_2"
    at = last.pose.position
    assert (at.x, at.y, at.z) == pytest.approx((3.8, 3.5, 0.0), abs=0.02)

    server.feedback.clear()
    look_at(page, viewer, -3.0, 0.0)
    start = on_screen(page, (-3.17, -0.17, 0.2))  # beside the arrow that points up
    page.tab.mouse.move(*start)
    page.tab.mouse.down()
    page.tab.mouse.move(start[0] + 75, start[1], steps=5)  # a quarter about the camera's up
    page.tab.mouse.up()
    last = wait_for(page, server, UP)[-1]
    turned = last.pose.orientation
    half = math.sqrt(0.5)
    assert (turned.x, turned.y, turned.z, turned.w) == pytest.approx((0, half, 0, half), abs=0.02)
    assert (last.pose.position.x, last.pose.position.y) == (-3.0, 0.0)


def test_a_marker_stays_where_its_server_leaves_it_drag_after_drag(
    page: Page, viewer: webviz.Viewer, server: MarkerServer
) -> None:
    """The server sends back the very poses of the drag."""
    for _ in range(3):
        x, y, _ = pose(page, "simple_2")[0]
        look_at(page, viewer, x, y)
        server.feedback.clear()
        drag(page, (x, y, 0.2), (x + 0.4, y - 0.3, 0.2))
        wait_for(page, server, UP)
        page.wait_for(lambda: markers_on_page(page)["simple_2"]["holder"] is None, "the release")
        at = server.markers["simple_2"].pose.position
        assert (at.x, at.y) == pytest.approx((x + 0.4, y - 0.3), abs=0.02)
        for _ in range(6):
            page.draw()
        assert pose(page, "simple_2")[0] == pytest.approx([at.x, at.y, at.z], abs=1e-4)


def test_a_finger_that_rests_opens_the_menu_and_one_that_moves_drags(
    page: Page, viewer: webviz.Viewer, server: MarkerServer
) -> None:
    chess = server.markers["chess_piece"]
    chess.menu_entries = [MenuEntry(id=1, title="Castle")]
    server.insert(chess)
    server.apply()
    page.wait_for(lambda: len(markers_on_page(page)["chess_piece"]["menu"]) == 1, "the menu")
    x, y = pose(page, "chess_piece")[0][:2]
    look_at(page, viewer, x, y)
    place = on_screen(page, (x, y, 0.2))
    session = page.tab.context.new_cdp_session(page.tab)

    def touch(kind: str, *points: tuple[float, float]) -> None:
        where = [{"x": x, "y": y} for x, y in points]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": where})

    entry = page.tab.locator(".wv-menu").get_by_text("Castle")
    for _ in range(3):  # a browser on a busy machine may cancel a touch
        server.feedback.clear()
        touch("touchStart", place)
        wait_for(page, server, UP)
        touch("touchEnd")
        with contextlib.suppress(playwright.TimeoutError):
            entry.wait_for(timeout=10_000)
            break
    entry.click()
    assert wait_for(page, server, MENU)[-1].menu_entry_id == 1

    server.feedback.clear()
    touch("touchStart", place)
    for step in range(1, 6):
        touch("touchMove", (place[0], place[1] - 10.0 * step))
    touch("touchEnd")
    move_feedback = wait_for(page, server, UP)[-1]
    assert move_feedback.pose.position.y == pytest.approx(y + 0.5, abs=0.05)
    page.wait_for(lambda: page.tab.locator(".wv-menu").count() == 0, "no menu")


def test_buttons_and_menus_report_clicks_and_no_shell_command_is_offered(
    page: Page, viewer: webviz.Viewer, server: MarkerServer
) -> None:
    look_at(page, viewer, 0.0, -9.0)
    page.tab.mouse.click(*on_screen(page, (0.0, -9.0, 0.2)))
    events = [each.event_type for each in wait_for(page, server, UP)]
    assert events == [UPDATE, DOWN, CLICK, UPDATE, UP]

    server.feedback.clear()
    look_at(page, viewer, 3.0, -6.0)
    place = on_screen(page, (3.0, -6.0, 0.2))
    page.tab.mouse.click(*place)
    menu = page.tab.locator(".wv-menu").first
    menu.get_by_text("Submenu").click()
    disabled = page.tab.get_by_text("Format the disk").locator("xpath=..")
    playwright.expect(disabled).to_have_count(1)  # the one that the pointer opened is gone
    assert disabled.get_attribute("aria-disabled") == "true"
    assert "shell command" in (disabled.get_attribute("data-tip") or "")
    page.tab.get_by_text("First Subentry").click()
    chosen = wait_for(page, server, MENU)[-1]
    assert (chosen.menu_entry_id, chosen.control_name) == (4, "menu_only_control")
    assert chosen.mouse_point_valid
    page.wait_for(lambda: page.tab.locator(".wv-menu").count() == 0, "no menu")


def test_one_browser_drags_and_others_see_who(
    page: Page, pages: list[Page], viewer: webviz.Viewer, server: MarkerServer
) -> None:
    other = pages[1]
    look_at(page, viewer, 0.0, -6.0)
    other.draw()
    number = page.tab.evaluate("window.webviz.browser")
    page.tab.mouse.move(*on_screen(page, (0.5, -6.0, 0.2)))
    page.tab.mouse.down()
    page.tab.mouse.move(*on_screen(page, (0.9, -6.0, 0.2)), steps=4)
    other.wait_for(lambda: markers_on_page(other)["moving"]["holder"] == number, "the holder")
    other.wait_for(
        lambda: pose(other, "moving")[0][0] == pytest.approx(0.4, abs=0.03), "the drag elsewhere"
    )
    other.tab.mouse.move(*on_screen(other, (0.9, -6.0, 0.2)))
    other.tab.mouse.down()
    hint = other.tab.locator(".wv-hint")
    other.wait_for(
        lambda: f"In use by browser {number}." in (hint.text_content() or ""), "who drags"
    )
    other.tab.mouse.up()
    wait_for(page, server, KEEP_ALIVE)
    page.tab.mouse.up()
    feedback = wait_for(page, server, UP)
    assert len(feedback) == len([each for each in feedback if each.marker_name == "moving"])
    assert feedback[-1].header.frame_id == "moving_frame"
    assert feedback[-1].pose.position.x == pytest.approx(0.4, abs=0.03)
    assert feedback[-1].mouse_point.x == pytest.approx(0.4, abs=0.03)
    other.wait_for(lambda: markers_on_page(other)["moving"]["holder"] is None, "the release")


def test_controls_are_lit_under_the_pointer_and_hidden_from_other_tools(
    page: Page, viewer: webviz.Viewer
) -> None:
    look_at(page, viewer, 3.0, -3.0)
    at, _ = pose(page, "chess_piece")
    ring = on_screen(page, (at[0] + 0.57, at[1], 0.0))
    dark = around(page, ring)
    page.tab.mouse.move(*ring)
    page.wait_for(lambda: around(page, ring) != dark, "light")
    hint = page.tab.locator(".wv-hint")
    page.wait_for(lambda: "Left-click: Move." in (hint.text_content() or ""), "what it does")
    page.tab.mouse.move(450, 695)
    page.wait_for(lambda: around(page, ring) == dark, "no light")
    page.tab.keyboard.press("m")
    page.wait_for(lambda: not is_visible(page, "chess_piece", 1), "no ring")
    assert is_visible(page, "chess_piece", 0), "the box is always visible"
    page.tab.keyboard.press("i")
    page.wait_for(lambda: is_visible(page, "chess_piece", 1), "the ring")


def around(page: Page, place: tuple[float, float]) -> list[Any]:
    """The colours of the scene around a place of the window."""
    left, top = page.evaluate("""() => {
      const { left, top } = document.querySelector("canvas").getBoundingClientRect();
      return [left, top];
    }""")
    column, row = (round(RESOLUTION * each) for each in (place[0] - left, place[1] - top))
    return page.pixels()[row - 1 : row + 2, column - 1 : column + 2].tolist()


def is_visible(page: Page, name: str, control: int) -> bool:
    return page.tab.evaluate(
        """async ([id, control]) => {
          const { nodesOf } = await import("webviz/features/handles/registry.js");
          const { node } = await import("webviz/viser_page.js");
          return nodesOf(id).parts.get(control).every((path) => node(path).visible);
        }""",
        [markers_on_page(page)[name]["id"], control],
    )


def test_controls_that_face_the_camera_do_so_in_every_view(
    page: Page, viewer: webviz.Viewer
) -> None:
    """The ring around the x axis of its control is seen from the front: as wide as it is tall."""
    marker = markers_on_page(page)["view_facing"]["id"]
    ahead, left, up = [0.0, 0.0, -1.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]

    def axes() -> Any:
        return page.tab.evaluate(
            """async (id) => {
              const { nodesOf } = await import("webviz/features/handles/registry.js");
              const { node, camera } = await import("webviz/viser_page.js");
              const group = node(nodesOf(id).groups.get("0v"));
              const seen = camera().matrixWorldInverse.clone().multiply(group.matrixWorld);
              return seen.elements.slice(0, 12);
            }""",
            marker,
        )

    expected = pytest.approx([*ahead, *left, *up], abs=1e-6)
    for yaw, pitch in ((0.3, 0.2), (2.5, 1.2)):
        view = {"distance": 6.0, "yaw": yaw, "pitch": pitch, "focal_point": [-3.0, -3.0, 0.0]}
        viewer.do(ShowView(checked_view({"type": "Orbit", **view})))
        page.draw()
        page.wait_for(lambda: axes() == expected, "facing the camera")


def test_a_browser_that_leaves_during_a_drag_lets_go(
    page: Page, pages: list[Page], viewer: webviz.Viewer, server: MarkerServer
) -> None:
    other = pages[1]
    look_at(other, viewer, 3.0, 3.0)
    x, y = pose(other, "simple_2")[0][:2]
    other.tab.mouse.move(*on_screen(other, (x, y, 0.2)))
    other.tab.mouse.down()
    other.tab.mouse.move(*on_screen(other, (x - 0.5, y, 0.2)), steps=4)
    page.wait_for(lambda: markers_on_page(page)["simple_2"]["holder"] is not None, "the holder")
    other.close()
    page.wait_for(lambda: markers_on_page(page)["simple_2"]["holder"] is None, "the release")
    assert wait_for(page, server, UP)[-1].marker_name == "simple_2"
