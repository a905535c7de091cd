"""A display is added, changed and saved: it comes back, as does what a crash left unsaved."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import building
import numpy as np
import photos
import playwright.sync_api as playwright
import pytest
from displays_panel import DisplaysPanel
from program import Program

from webviz.data.messages import encode
from webviz.shell.pictures.browser import Page, Pixels
from webviz.shell.testing import header

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from webviz.ros.publisher_node import PublisherNode

BRICK = np.array((200, 60, 20))

EMPTY = """\
fixed_frame: map
view: {distance: 20.0, yaw: -1.570796, pitch: 1.5697}
"""


def picture(page: Page) -> Pixels:
    """Return the picture of the page once it stays the same for a second."""
    before = page.pixels()
    for _ in range(60):
        page.tab.wait_for_timeout(1000)
        page.draw()
        now = page.pixels()
        if np.array_equal(now, before):
            return now
        before = now
    raise AssertionError("the picture does not come to rest")


def colors(pixels: Pixels) -> int:
    """Return the number of colours that fill at least a thousandth of a picture."""
    _, counts = np.unique(pixels.reshape(-1, 3), axis=0, return_counts=True)
    return int((counts > pixels.size / 3000).sum())


@pytest.fixture
def publish(ros_env: dict[str, str]) -> Iterator[Callable[..., None]]:
    """Publish a message over DDS, for as long as the test takes."""
    talker = PublisherNode("robot", int(ros_env["ROS_DOMAIN_ID"]))

    def publish(topic: str, type_name: str, values: dict[str, Any]) -> None:
        talker.open(topic, type_name, latched=True).publish(encode(type_name, values))

    yield publish
    talker.close()


def test_saved_displays_return_and_unsaved_changes_survive_a_kill(
    start: Callable[..., Program],
    open_page: Callable[..., Page],
    publish: Callable[..., None],
    tmp_path: Path,
) -> None:
    """One tab sees three viewers on one port."""
    config, lab, state = tmp_path / "empty.yaml", tmp_path / "lab.yaml", tmp_path / "state"
    config.write_text(EMPTY)

    def view(path: Path, port: int) -> Program:
        arguments = ("webviz", "--port", str(port), "-d", str(path))
        return start(*arguments, env={"XDG_STATE_HOME": str(state)})

    publish("/map", "nav_msgs/msg/OccupancyGrid", building.grid() | {"header": header("map", 0)})
    viewer = view(config, 0)
    page = open_page(url := viewer.url(), 1000, 700, 0.3)
    page.hold()
    side, tab = DisplaysPanel(page), page.tab
    port, dialog = int(url.rpartition(":")[2]), tab.get_by_role("dialog")
    blank = picture(page)
    assert colors(blank) == 1

    add(tab, "/map Map")
    side.select("Map")
    side.wait_for("Map: 248 x 168 cells")
    page.wait_for(lambda: page.draw() or colors(page.pixels()) >= 3, "the map")
    added = picture(page)

    side.field("color_scheme").fill("costmap")
    side.field("color_scheme").press("Enter")
    page.wait_for(lambda: (page.pixels() != added).mean() > 0.05, "the colours change")
    changed = picture(page)

    tab.keyboard.press("Control+Shift+S")
    dialog.get_by_role("textbox").fill("lab")
    dialog.get_by_role("button", name="Save", exact=True).click()
    page.wait_for(lambda: "Saved lab.yaml." in page.text(), "the answer")
    lab_text = lab.read_text()
    assert "color_scheme: costmap" in lab_text
    assert config.read_text() == EMPTY
    tab.reload()
    tab.wait_for_function("window.webviz?.hasView()")
    page.hold()
    side.select("Map")
    page.wait_for(lambda: (picture(page) == changed).all(), "the same picture", 60)

    bricks = photos.raw(np.full((24, 32, 3), BRICK, np.uint8), "rgb8")
    publish("/camera/image_raw", photos.RAW, bricks)
    add(tab, "/camera/image_raw Image")
    pane = tab.get_by_label("Image /camera/image_raw", exact=True)
    canvas = pane.locator("canvas")
    page.wait_for(lambda: np.abs(canvas.evaluate(MIDDLE) - BRICK).max() < 4, "the image", 60)
    side.select("Map")
    tab.keyboard.press("Delete")
    page.wait_for(lambda: page.draw() or colors(page.pixels()) == 1, "nothing")
    assert viewer.end() == 0

    viewer = view(lab, port)
    pane.wait_for(state="detached")
    page.wait_for(lambda: (picture(page) == changed).all(), "the same picture", 60)
    side.select("Map")
    side.wait_for("248 x 168 cells")

    tab.keyboard.press("F2")
    tab.keyboard.type("Ground")
    tab.keyboard.press("Enter")
    page.wait_for(lambda: any(state.rglob("lab-*.yaml")), "the session")
    assert viewer.end(signal.SIGKILL) == -signal.SIGKILL

    viewer = view(lab, port)
    viewer.wait_for(r"Restored 1 display of the last session. Start with --no-restore to see the")
    tab.get_by_text("Restored 1 display of the last session.").wait_for()
    tree = tab.get_by_role("tree")
    tree.get_by_text("Ground").wait_for()
    tab.locator(".wv-toast").get_by_role("button", name="Undo").click()
    tree.get_by_text("Map", exact=True).wait_for()
    assert lab.read_text() == lab_text
    assert viewer.end() == 0
    assert not any(state.rglob("lab-*.yaml"))


def add(tab: playwright.Page, option: str) -> None:
    """Add a display by its topic."""
    tab.get_by_role("button", name="Add display").click()
    dialog = tab.get_by_role("dialog")
    dialog.get_by_role("tab", name="By topic").click()
    dialog.get_by_role("option", name=option, exact=True).click(timeout=60_000)
    dialog.get_by_role("button", name="Add", exact=True).click()


MIDDLE = """(canvas) => {
  const place = [canvas.width >> 1, canvas.height >> 1, 1, 1];
  return [...canvas.getContext("2d").getImageData(...place).data.slice(0, 3)];
}"""
