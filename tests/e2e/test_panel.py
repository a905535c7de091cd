"""Add a display by its topic, change it, save, come back: the same picture."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import photos
import pytest
from numpy.typing import NDArray
from program import Program
from side import Side

from webviz.data.messages import encode
from webviz.shell.pictures.browser import Page, Pixels

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


def test_a_display_is_added_by_topic_changed_saved_and_comes_back(
    start: Callable[..., Program], open_page: Callable[..., Page], tmp_path: Path
) -> None:
    config = tmp_path / "empty.yaml"
    config.write_text(EMPTY)
    start("webviz_sim", "--ros-args", "-p", "tour:=false")
    viewer = start("webviz", "--port", "0", "-d", str(config))
    page = open_page(viewer.url(), 1000, 700, 0.3)
    page.hold()
    side, tab = Side(page), page.tab
    blank = picture(page)
    assert colors(blank) == 1

    tab.get_by_role("button", name="Add display").click()
    dialog = tab.get_by_role("dialog")
    dialog.get_by_role("tab", name="By topic").click()
    dialog.get_by_role("option", name="/map").first.click(timeout=60_000)
    dialog.get_by_role("button", name="Add", exact=True).click()
    side.select("Map")
    side.wait_for("Map: 248 x 168 cells")
    page.wait_for(lambda: page.draw() or colors(page.pixels()) >= 3, "the map")
    added = picture(page)

    side.field("color_scheme").select_option("costmap")
    page.wait_for(lambda: (page.pixels() != added).mean() > 0.05, "the colours change")
    changed = picture(page)

    tab.keyboard.press("Control+Shift+S")
    dialog.get_by_role("textbox").fill("lab")
    dialog.get_by_role("button", name="Save", exact=True).click()
    page.wait_for(lambda: "Saved lab.yaml." in page.text(), "the answer")
    assert "color_scheme: costmap" in (tmp_path / "lab.yaml").read_text()
    assert config.read_text() == EMPTY
    tab.reload()
    tab.wait_for_function("window.webviz?.hasView()")
    page.hold()
    side.select("Map")
    page.wait_for(lambda: (picture(page) == changed).all(), "the same picture", 60)
    assert viewer.end() == 0

    again = start("webviz", "--port", "0", "-d", str(tmp_path / "lab.yaml"))
    page = open_page(again.url(), 1000, 700, 0.3)
    page.hold()
    side = Side(page)
    side.select("Map")
    side.wait_for("248 x 168 cells")
    page.wait_for(lambda: (picture(page) == changed).all(), "the same picture", 60)
    with camera(np.full((24, 32, 3), BRICK, np.uint8)):
        tab = page.tab
        tab.get_by_role("button", name="Add display").click()
        dialog = tab.get_by_role("dialog")
        dialog.get_by_role("tab", name="By topic").click()
        option = dialog.get_by_role("option", name="/camera/image_raw Image", exact=True)
        option.click(timeout=60_000)
        dialog.get_by_role("button", name="Add", exact=True).click()
        canvas = tab.get_by_label("Image /camera/image_raw", exact=True).locator("canvas")
        page.wait_for(lambda: np.abs(canvas.evaluate(MIDDLE) - BRICK).max() < 4, "the image", 60)


MIDDLE = """(canvas) => {
  const place = [canvas.width >> 1, canvas.height >> 1, 1, 1];
  return [...canvas.getContext("2d").getImageData(...place).data.slice(0, 3)];
}"""


@contextlib.contextmanager
def camera(pixels: NDArray[np.uint8]) -> Iterator[None]:
    """An image over DDS."""
    talker = PublisherNode("camera", int(os.environ["ROS_DOMAIN_ID"]))
    try:
        cdr = encode(photos.RAW, photos.raw(pixels, "rgb8"))
        talker.open("/camera/image_raw", photos.RAW, latched=True).publish(cdr)
        yield
    finally:
        talker.close()
