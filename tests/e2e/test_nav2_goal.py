"""The tool Nav2 Goal in two browsers, with the action servers of the simulator over DDS."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from typing import Any

import playwright.sync_api as playwright
import pytest
from pages import open_pages
from program import Program

import webviz
from webviz.features import goals
from webviz.files.config import Config
from webviz.files.opening import parse
from webviz.shell.pictures.browser import Page

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from webviz.ros.node import RosSource

SCALE = 50.0
"""Pixels of a metre; up on the screen is +y."""
FAR, NEAR, WALL = 1.3, -0.9, (0.1, -3.8)
"""Places in the map: the robot needs most of a minute to the first and a moment to the second."""
CONFIG = """\
fixed_frame: map
view: {type: TopDownOrtho, scale: 50}
tools: [{type: Nav2Goal}]
displays: [{type: Grid}]
"""


@pytest.fixture(scope="module")
def start_robot(start: Callable[..., Program]) -> Callable[[], Program]:
    """Start a robot that stands in the corridor, with room ahead, and is slow."""
    pose, speed = "start_pose:=[-1.0, 0.0, 0.0]", "tour_speed:=0.05"
    return lambda: start("webviz_sim", "--ros-args", "-p", "tour:=false", "-p", pose, "-p", speed)


@pytest.fixture(scope="module")
def robot(start_robot: Callable[[], Program]) -> Program:
    return start_robot()


@pytest.fixture(scope="module")
def viewer(ros_env: dict[str, str]) -> Iterator[webviz.Viewer]:
    def read(*_: object) -> Config:
        return parse(CONFIG, "x.yaml")

    source = RosSource(domain_id=int(ros_env["ROS_DOMAIN_ID"]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(goals, "SHOWN_S", 1000.0)  # however slow this machine is
        with webviz.Viewer(port=0, source=source, read=read) as viewer:
            yield viewer


@pytest.fixture(scope="module")
def pages(browser: playwright.Browser, viewer: webviz.Viewer) -> Iterator[list[Page]]:
    with open_pages(browser, viewer.url, 900, 600) as open_tabs:
        yield open_tabs


@pytest.fixture
def page(pages: list[Page], robot: Program, viewer: webviz.Viewer) -> Page:
    """The first page, with the tool ready and no goal."""
    page = pages[0]
    page.wait_for(lambda: "/odom" in viewer.topics, "the robot", 60)
    page.wait_for(lambda: button(page, "Nav2 Goal").count() == 1, "the tool")
    page.tab.locator(".wv-first-run, .wv-toast").evaluate_all(
        "(all) => all.forEach((one) => one.remove())"
    )
    page.draw()
    return page


def button(page: Page, name: str) -> Any:
    return page.tab.get_by_role("button", name=name, exact=True)


def card(page: Page) -> str:
    """All cards of goals as text, in one line."""
    texts = page.tab.locator(".wv-goal").all_inner_texts()
    return " ".join(" | ".join(texts).split())


def drag(page: Page, x: float, y: float, keys: str = "") -> None:
    """Send a pose at a place of the map, with its heading along x."""
    box = page.tab.evaluate(
        "(() => { const b = window.__viserMutable.canvas.getBoundingClientRect();"
        "return [b.left + b.width / 2, b.top + b.height / 2]; })()"
    )
    left, top = box[0] + x * SCALE, box[1] - y * SCALE
    if button(page, "Nav2 Goal").get_attribute("aria-pressed") != "true":
        button(page, "Nav2 Goal").click()
    if keys:
        page.tab.keyboard.down(keys)
    page.tab.mouse.move(left, top)
    page.tab.mouse.down()
    page.tab.mouse.move(left + 60.0, top, steps=3)
    page.tab.mouse.up()
    if keys:
        page.tab.keyboard.up(keys)


def until(page: Page, text: str) -> None:
    page.wait_for(lambda: text in card(page), text, 60)


def test_all_pages_follow_a_goal_and_any_of_them_cancels_it(page: Page, pages: list[Page]) -> None:
    drag(page, FAR, 0.0)
    for each in pages:
        until(each, "Distance left")
        until(each, "Recoveries 0 Cancel")
        assert each.tab.locator("[data-webviz=routes] .wv-pose-arrow").count() == 1
    button(pages[1], "Cancel").click()
    for each in pages:
        until(each, "Cancelled.")
        arrows = each.tab.locator("[data-webviz=routes] .wv-pose-arrow")
        each.wait_for(lambda arrows=arrows: arrows.count() == 0, "no route")


def test_a_goal_is_reached_or_aborted_with_nav2s_error_until_a_page_dismisses_it(
    page: Page, pages: list[Page]
) -> None:
    drag(page, *WALL)
    until(page, "Aborted. Error 206: The goal is in an obstacle or in unknown space.")
    drag(page, NEAR, 0.0)
    for each in pages:
        until(each, f"x {NEAR:.2f} y 0.00 m Reached the goal.")
        assert "Aborted" not in card(each)
    button(pages[1], "Dismiss").click()
    page.wait_for(lambda: card(page) == "", "no card")


def test_waypoints_are_numbered_removed_and_sent_together(page: Page, pages: list[Page]) -> None:
    element = page.tab.locator("[data-webviz=waypoints] .wv-pose-number")
    drag(page, 0.2, 0.0, "Shift")
    for x in (0.4, 0.6, 0.8):
        drag(page, x, 0.0)
    assert element.all_text_contents() == ["1", "2", "3", "4"]
    button(page, "Remove the last waypoint").click()
    assert element.all_text_contents() == ["1", "2", "3"]
    button(page, "Remove all waypoints").click()
    assert element.count() == 0
    for x in (0.5, FAR):
        drag(page, x, 0.0)
    button(page, "Stop at each").click()
    assert element.count() == 0
    until(pages[1], "2 waypoints Waypoint 1 of 2")
    assert button(page, "Nav2 Goal").get_attribute("aria-pressed") == "false"
    # At another action the goal before is cancelled first; then this one replaces it.
    drag(page, FAR, 0.0)
    page.wait_for(lambda: "2 waypoints" not in card(page), "the goal before to end", 60)
    until(page, "Distance left")
    # At the same action the server preempts it.
    drag(page, 0.5, 0.0)
    until(page, "x 0.50 y 0.00 m Distance left")
    page.wait_for(lambda: card(page).count("Nav2 Goal") == 1, "the goal before to end", 60)
    button(page, "Cancel").click()
    until(page, "Cancelled.")


def test_the_panel_shows_nav2_starts_and_stops_it_and_cancels_the_goals_of_all(page: Page) -> None:
    button(page, "Add a panel").click()
    page.tab.get_by_role("option", name="Navigation 2").click()
    page.tab.get_by_role("tab", name="Navigation 2").click()

    def reads(text: str) -> None:
        panel = page.tab.locator(".wv-plugin")
        page.wait_for(lambda: text in " ".join(panel.inner_text().split()), text, 60)

    reads("Navigation active Localization unknown: No node offers")
    drag(page, FAR, 0.0)
    reads("navigate_to_pose State active")
    reads("Distance left")
    button(page, "Cancel all goals").click()
    reads("navigate_to_pose 1 cancelled.")
    reads("follow_waypoints Nothing cancelled: no goal is active.")
    reads("navigate_to_pose State cancelled")
    page.tab.locator(".wv-plugin").get_by_role("button", name="Pause").click()
    reads("Navigation inactive")
    reads("Navigation Done.")
    drag(page, NEAR, 0.0)
    page.wait_for(
        lambda: page.tab.get_by_text("/navigate_to_pose rejected the goal.").count() > 0, "rejected"
    )
    button(page, "Resume").click()
    reads("Navigation active")
    button(page, "More for this panel").click()
    page.tab.get_by_role("menuitem", name="Remove panel").click()
    page.wait_for(lambda: button(page, "Cancel all goals").count() == 0, "no panel")


def test_numbers_of_the_robot_are_plotted_and_read(page: Page, viewer: webviz.Viewer) -> None:
    button(page, "Add a panel").click()
    page.tab.get_by_role("option", name="Plot").click()
    button(page, "Add a field").click()
    page.tab.get_by_role("combobox", name="Topic", exact=True).fill("/odom")
    page.tab.get_by_role("option", name="/odom", exact=True).click()
    page.tab.get_by_role("option", name="twist.twist.linear.z", exact=True).click()
    page.tab.keyboard.press("Escape")
    value = page.tab.locator(".wv-chart-value")
    page.wait_for(lambda: value.all_inner_texts() == ["0 m/s"], "the value of the curve")
    display = viewer.add("Text", topic="/odom", fields=["child_frame_id"])
    pane = page.tab.get_by_label("Text /odom", exact=True)
    page.wait_for(lambda: pane.count() and "'base_link'" in pane.inner_text(), "the text")
    display.remove()
    page.wait_for(lambda: not pane.count(), "room for the scene")
    button(page, "Remove panel").click()


def test_servers_that_are_killed_while_they_cancel_end_or_are_not_there_are_named(
    page: Page,
    pages: list[Page],
    robot: Program,
    start_robot: Callable[[], Program],
    viewer: webviz.Viewer,
) -> None:
    drag(page, FAR, 0.0)
    until(page, "Distance left")
    robot.process.send_signal(signal.SIGSTOP)
    button(page, "Cancel").click()
    page.wait_for(button(page, "Cancel").is_disabled, "the request to cancel")
    robot.end(signal.SIGKILL)
    robot = start_robot()
    # Cancel works again, as no server answered; the server that runs now does not know the goal.
    ended = "no longer knows this goal. Send it again.", "has ended. Start Nav2's bt_nav"
    cancel = page.tab.locator(".wv-goal .wv-button:enabled:visible")

    def is_over() -> bool:
        cancel.evaluate_all("(all) => all.forEach((one) => one.click())")
        return any(text in card(page) for text in ended)

    page.wait_for(is_over, "the end of the goal", 60)
    button(page, "Dismiss").click()
    page.wait_for(lambda: card(page) == "", "no card")
    drag(page, FAR, 0.0)
    until(page, "Distance left")
    button(page, "Cancel").click()
    until(page, "Cancelled.")

    drag(page, FAR, 0.0)
    until(page, "Distance left")
    robot.end(signal.SIGINT)
    until(pages[1], "The node that offered /navigate_to_pose has ended. Start Nav2's bt_navigator")
    with pytest.raises(
        webviz.Error, match=r"No node offers /navigate_to_pose\. Start Nav2's bt_nav"
    ):
        viewer.tool("Nav2 Goal").send(0.0, 0.0)
