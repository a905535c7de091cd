"""The controls of the tool that drives, and what they send."""

from __future__ import annotations

from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest

from tests.page.conftest import Tab
from webviz.api.vehicle import STILL, Velocity
from webviz.engine.driving import DrivingAnswer
from webviz.features.driving import Driving
from webviz.features.tools.toolbar import ToolButton
from webviz.scene.server import Server
from webviz.tools.teleop import Teleop

CAMERA = """(() => {
  const { position, target } = JSON.parse(window.__viserMutable.cameraControl.toJSON());
  return [...position, ...target];
})()"""
"""Pose to which the camera goes: its own still follows the last drag, of another test."""
PAD = """(axes) => { navigator.getGamepads = () => [{connected: true, axes}] }"""


def button(lateral: float = 0.0) -> ToolButton:
    tool = Teleop(lateral=lateral)
    return ToolButton("drive", "Teleop", "Drive.", "t", "drive", "wheel", tool=tool)


@pytest.fixture
def driver(tab: Tab) -> Iterator[Tab]:
    """A tab with the tool selected and a robot that moves."""
    open_card(tab)
    yield tab
    tab.page.keyboard.press("Escape")
    playwright.expect(card(tab)).to_have_count(0)
    tab.loop.controller = DrivingAnswer()


def open_card(tab: Tab, lateral: float = 0.0) -> None:
    tab.loop.controller = DrivingAnswer()
    tab.loop.show(tools=(button(lateral),), driving={"drive": Driving(None, -0.25, 1.5)})
    tab.wait_for(lambda: tab.page.locator(".wv-tool[aria-label=Teleop]").count() == 1)
    tab.page.locator(".wv-tool[aria-label=Teleop]").click()
    tab.wait_for(lambda: "\u22120.25" in card(tab).inner_text())
    tab.loop.steered.clear()


def card(tab: Tab) -> playwright.Locator:
    return tab.page.get_by_role("region", name="Teleop")


def wait_for_share(tab: Tab, *share: float) -> None:
    """Wait until the newest heartbeat says that this is held."""
    expected = pytest.approx(share, abs=0.03)
    tab.wait_for(lambda: tab.loop.steered and (tab.loop.steered[-1][2] or ()) == expected)


def test_keys_drive_while_they_are_held_and_leave_the_camera_and_other_tools_alone(
    driver: Tab,
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
    assert all(share is None or share.lateral == 0 for _, _, share in driver.loop.steered)
    driver.page.mouse.click(700, 300)
    keys.down("s")  # of another tool, if this one were not active
    wait_for_share(driver, -1, 0, 0)
    keys.press("Escape")
    wait_for_share(driver, *STILL)
    keys.up("s")
    keys.press("t")
    # A wheel that another test has turned may still move it by micrometres.
    assert driver.page.evaluate(CAMERA) == pytest.approx(before, abs=1e-3)


def test_the_mouse_moves_the_camera_while_a_key_drives(driver: Tab) -> None:
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
    driver: Tab, away: str
) -> None:
    driver.page.keyboard.down("w")
    wait_for_share(driver, 1, 0, 0)
    driver.page.evaluate(away)
    wait_for_share(driver, *STILL)
    driver.page.keyboard.up("w")
    driver.page.evaluate("document.activeElement.blur()")


def test_the_stick_drives_by_mouse_with_a_share_of_the_limits(driver: Tab) -> None:
    stick = driver.page.get_by_role("application")
    box = stick.bounding_box()
    assert box is not None
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


def test_a_gamepad_drives_once_its_stick_has_been_in_its_middle(driver: Tab) -> None:
    page = driver.page
    page.evaluate(PAD, [0, -1, 0])
    driver.loop.steered.clear()
    driver.wait_for(lambda: len(driver.loop.steered) > 3)
    page.keyboard.press("Escape")
    page.keyboard.press("t")  # it is held aside when the tool is chosen
    driver.loop.steered.clear()
    driver.wait_for(lambda: len(driver.loop.steered) > 2)
    assert {share for _, _, share in driver.loop.steered} <= {STILL, None}
    page.evaluate(PAD, [0.1, -0.05, 0])
    driver.loop.steered.clear()
    driver.wait_for(lambda: len(driver.loop.steered) > 2)
    page.evaluate(PAD, [-0.575, -1, 0])
    wait_for_share(driver, 1, 0, 0.5)
    page.evaluate("navigator.getGamepads = () => [null]")
    wait_for_share(driver, *STILL)


def test_the_card_shows_the_robot_who_drives_and_why_nothing_moves(driver: Tab) -> None:
    readout = card(driver).locator("dd")
    assert readout.all_inner_texts() == ["\u22120.25m/s", "1.50rad/s"]
    note = card(driver).get_by_role("status")
    driver.loop.controller = DrivingAnswer(99)
    driver.wait_for(lambda: "Browser 99 is driving. You can drive once" in note.inner_text())
    driver.loop.controller = DrivingAnswer(None, "This bag can only be read. <b>")
    driver.wait_for(lambda: note.inner_text() == "This bag can only be read. <b>")
    driver.loop.controller = DrivingAnswer(driver.page.evaluate("window.webviz.browser"))
    driver.wait_for(lambda: not note.is_visible())
    driver.loop.show(tools=(button(),), driving={})
    driver.wait_for(lambda: readout.first.inner_text() == "\u2013m/s")


def test_heartbeats_that_are_old_or_not_valid_move_nothing(driver: Tab, server: Server) -> None:
    send = "async (drive) => (await import('webviz/channel.js')).send({type: 'Drive', ...drive})"
    good = {"tool": "drive", "beat": 0, "linear": 1, "lateral": 0, "angular": 0}
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
    driver.wait_for(lambda: any(tool == "foreign" for tool, _, _ in driver.loop.steered))
    shares = {share for _, _, share in driver.loop.steered}
    assert shares <= {None, STILL}
    assert Velocity(linear=1.0) not in shares
    for _ in range(300):
        driver.page.evaluate(send, good)
    driver.loop.steered.clear()
    driver.page.keyboard.down("w")
    wait_for_share(driver, 1, 0, 0)  # a flood delays, but does not deafen
    driver.page.keyboard.up("w")
    wait_for_share(driver, *STILL)
