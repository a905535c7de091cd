"""The controls of the tool that drives, and what they send."""

from __future__ import annotations

import time
from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest
from pages import bounds

from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.api.vehicle import STILL, Velocity
from webviz.features.driving import ODOMETRY
from webviz.server.channel.messages import Drive
from webviz.sources import ReadOnly
from webviz.tools.teleop import Teleop

CAMERA = """(() => {
  const { position, target } = JSON.parse(window.__viserMutable.cameraControl.toJSON());
  return [...position, ...target];
})()"""
"""Pose to which the camera goes: its own still follows the last drag, of another test."""
PAD = """(axes) => { navigator.getGamepads = () => [{connected: true, axes}] }"""


LIMITS = Velocity(0.5, 0.25, 2.0)
TOPIC = "/cmd_vel"


@pytest.fixture
def tab(viewer_tab: ViewerTab) -> ViewerTab:
    return viewer_tab


@pytest.fixture
def driver(tab: ViewerTab) -> Iterator[ViewerTab]:
    """A tab with the tool selected and a robot that moves."""
    open_card(tab)
    yield tab
    tab.page.keyboard.press("Escape")
    playwright.expect(card(tab)).to_have_count(0)


@pytest.fixture
def heartbeats(viewer: PageBench) -> list[Drive]:
    """The heartbeats of pages."""
    heartbeats: list[Drive] = []
    viewer.listen(Drive, lambda browser, drive: heartbeats.append(drive))
    return heartbeats


def open_card(tab: ViewerTab, lateral: float = 0.0) -> None:
    """Select the tool, for a robot that reacts at once, and reports that it moves."""
    linear, _, angular = LIMITS
    tool = Teleop(
        name="Teleop",
        linear=linear,
        lateral=lateral,
        angular=angular,
        acceleration=500.0,
        deceleration=500.0,
        angular_acceleration=500.0,
        angular_deceleration=500.0,
    )
    tab.viewer.show(tools=[tool])
    tab.catch_up()  # the viewer before had a tool of this name, too
    tab.wait_for(lambda: tab.page.locator(".wv-tool[aria-label=Teleop]").count() == 1)
    tab.page.locator(".wv-tool[aria-label=Teleop]").click()
    tab.wait_for(lambda: shows_speed(tab))


def shows_speed(tab: ViewerTab) -> bool:
    """Return whether the card has the speed of the robot, which reports it once more."""
    twist = {"linear": {"x": -0.25}, "angular": {"z": 1.5}}
    tab.viewer.publish("/odom", ODOMETRY, {"twist": {"twist": twist}})
    return "\u22120.25" in card(tab).inner_text()


def card(tab: ViewerTab) -> playwright.Locator:
    return tab.page.get_by_role("region", name="Teleop")


def shares(viewer: PageBench) -> list[tuple[float, float, float]]:
    """The velocity commands that the robot got, as shares of its limits."""
    twists = [message for topic, message in viewer.published() if topic == TOPIC]
    axes = [(twist.linear.x, twist.linear.y, twist.angular.z) for twist in twists]
    x, y, turn = LIMITS
    return [(linear / x, lateral / y, angular / turn) for linear, lateral, angular in axes]


def wait_for_share(tab: ViewerTab, *share: float) -> None:
    """Wait until the robot was last told to go with these shares of its limits."""
    expected = pytest.approx(share, abs=0.03)
    tab.wait_for(lambda: shares(tab.viewer)[-1:] == [expected])


def test_keys_drive_while_they_are_held_and_leave_the_camera_and_other_tools_alone(
    heartbeats: list[Drive], driver: ViewerTab
) -> None:
    keys, before = driver.page.keyboard, driver.page.evaluate(CAMERA)
    for key, share in (
        ("w", (1, 0, 0)),
        ("a", (1, 0, 1)),
        ("ArrowDown", (0, 0, 1)),
        ("d", (0, 0, 0)),
    ):
        keys.down(key)
        wait_for_share(driver, *share)
    keys.up("w")
    wait_for_share(driver, -1, 0, 0)
    for key in ("a", "d", "ArrowDown"):
        keys.up(key)
    wait_for_share(driver, *STILL)
    keys.press("q")
    assert all(drive.lateral == 0 for drive in heartbeats)
    assert all(lateral == 0 for _, lateral, _ in shares(driver.viewer))
    driver.page.mouse.click(700, 300)
    keys.down("s")  # of another tool, if this one were not active
    wait_for_share(driver, -1, 0, 0)
    keys.press("Escape")
    wait_for_share(driver, *STILL)
    keys.up("s")
    keys.press("t")
    # A wheel that another test has turned may still move it by micrometres.
    assert driver.page.evaluate(CAMERA) == pytest.approx(before, abs=1e-3)


def test_the_mouse_moves_the_camera_while_a_key_drives(driver: ViewerTab) -> None:
    before = driver.page.evaluate(CAMERA)
    driver.page.keyboard.down("ArrowUp")
    mouse = driver.page.mouse
    mouse.move(600, 300)
    mouse.down()
    mouse.move(680, 300, steps=4)
    mouse.up()
    driver.wait_for(lambda: driver.page.evaluate(CAMERA) != before)
    wait_for_share(driver, 1, 0, 0)
    driver.page.keyboard.up("ArrowUp")
    wait_for_share(driver, *STILL)


@pytest.mark.parametrize(
    "away",
    [
        "window.dispatchEvent(new Event('blur'))",
        "window.dispatchEvent(new Event('pagehide'))",
        "document.querySelector('input[aria-label=\"Filter displays\"]').focus()",
    ],
)
def test_what_is_held_counts_as_let_go_when_people_turn_to_something_else(
    driver: ViewerTab, away: str
) -> None:
    driver.page.keyboard.down("w")
    wait_for_share(driver, 1, 0, 0)
    driver.page.evaluate(away)
    wait_for_share(driver, *STILL)
    driver.page.keyboard.up("w")
    driver.page.evaluate("document.activeElement.blur()")


def test_the_stick_drives_by_mouse_with_a_share_of_the_limits(driver: ViewerTab) -> None:
    stick = driver.page.get_by_role("application")
    box = bounds(stick)
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    reach = (box["width"] - stick.locator("div").evaluate("(knob) => knob.offsetWidth")) / 2
    mouse = driver.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x, y - reach / 2)
    wait_for_share(driver, 0.5, 0, 0)
    mouse.move(x + 300, y)  # beyond its edge
    wait_for_share(driver, 0, 0, -1)
    mouse.up()
    wait_for_share(driver, *STILL)


def test_a_gamepad_drives_once_its_stick_has_been_in_its_middle(
    heartbeats: list[Drive], driver: ViewerTab
) -> None:
    page = driver.page

    def wait_for_heartbeats(count: int) -> None:
        heartbeats.clear()
        driver.wait_for(lambda: len(heartbeats) > count)

    page.evaluate(PAD, [0, -1, 0])
    wait_for_heartbeats(3)
    page.keyboard.press("Escape")
    driver.catch_up()  # the last heartbeats have come
    page.keyboard.press("t")  # it is held aside when the tool is chosen
    wait_for_heartbeats(2)
    assert {(drive.linear, drive.lateral, drive.angular) for drive in heartbeats} == {STILL}
    driver.wait_for(lambda: not driver.viewer.viewer.controllers.is_moving())
    before = len(shares(driver.viewer))
    page.evaluate(PAD, [0.1, -0.05, 0])
    wait_for_heartbeats(2)
    assert {*shares(driver.viewer)[before:]} <= {STILL}
    page.evaluate(PAD, [-0.575, -1, 0])
    wait_for_share(driver, 1, 0, 0.5)
    page.evaluate("navigator.getGamepads = () => [null]")
    wait_for_share(driver, *STILL)


def test_the_card_shows_the_robot_who_drives_and_why_nothing_moves(
    driver: ViewerTab, monkeypatch: pytest.MonkeyPatch
) -> None:
    readout = card(driver).locator("dd")
    assert readout.all_inner_texts() == ["\u22120.25m/s", "1.50rad/s"]
    note = card(driver).get_by_role("status")
    viewer, (tool,) = driver.viewer, driver.viewer.viewer.context.tools.usable()
    steer = viewer.viewer.controllers.steer

    def is_another_driving() -> bool:
        steer(tool, 99, Velocity(0.5), time.monotonic())
        return "Browser 99 is driving. You can drive once" in note.inner_text()

    driver.wait_for(is_another_driving)
    refusal = ReadOnly("Nothing can be sent. <b>")
    monkeypatch.setattr(viewer.graph, "publish", refusal.publish)
    driver.page.keyboard.down("w")
    driver.wait_for(lambda: note.inner_text() == refusal.reason)
    monkeypatch.undo()
    wait_for_share(driver, 1, 0, 0)
    assert viewer.viewer.controllers.drivers() == {tool: driver.browser}
    driver.wait_for(lambda: not note.is_visible())
    driver.page.keyboard.up("w")
    viewer.pass_time(2.0)  # without odometry
    driver.wait_for(lambda: readout.first.inner_text() == "\u2013m/s")


def test_heartbeats_that_are_old_or_not_valid_move_nothing(
    heartbeats: list[Drive], driver: ViewerTab
) -> None:
    (tool,) = driver.viewer.viewer.context.tools.usable()
    send = "async (drive) => (await import('webviz/channel.js')).send({type: 'Drive', ...drive})"
    good = {"tool": tool, "beat": 0, "linear": 1, "lateral": 0, "angular": 0}
    for wrong in (
        {"linear": 1e308},
        {"linear": None},
        {"linear": "1"},
        {"angular": -1.01},
        {"beat": -1},
        {"tool": 5},
        {"more": 1},
    ):
        driver.page.evaluate(send, {**good, **wrong})
    driver.page.evaluate(send, {**good, "tool": "foreign", "beat": 12345})
    driver.page.evaluate(send, good)  # with a beat that is not known
    driver.wait_for(lambda: any(drive.tool == "foreign" for drive in heartbeats))
    driver.wait_for(lambda: any(drive.linear == 1 and drive.tool == tool for drive in heartbeats))
    assert {*shares(driver.viewer)} <= {STILL}
    for _ in range(300):
        driver.page.evaluate(send, good)
    driver.page.keyboard.down("w")
    wait_for_share(driver, 1, 0, 0)  # a flood delays, but does not deafen
    driver.page.keyboard.up("w")
    wait_for_share(driver, *STILL)
