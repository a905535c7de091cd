"""What a person does: add a display by its topic, change it, save, come back: the same picture."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import playwright.sync_api as playwright
import pytest
from program import Program

from webviz.shell.pictures.browser import Page, Pixels

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install webviz[ros]")

EMPTY = """\
fixed_frame: map
view: {distance: 20.0, yaw: -1.570796, pitch: 1.5697}
"""


class Hand:
    """What a person does with the panel of a page."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.tab = page.tab

    def press(self, name: str) -> None:
        self.tab.get_by_role("button", name=name, exact=True).last.click()

    def choose(self, label: str, option: str) -> None:
        self._field(label).click()
        self.tab.get_by_role("option", name=option, exact=True).click()

    def write(self, label: str, text: str) -> None:
        self._field(label).fill(text)
        # The page drops a click that follows within 50 ms, by its own clock.
        self.tab.evaluate("() => new Promise((done) => setTimeout(done, 60))")

    def sees(self, text: str) -> None:
        playwright.expect(self.tab.get_by_text(text).first).to_be_visible(timeout=30_000)

    def _field(self, label: str) -> playwright.Locator:
        text = self.tab.locator(f"label:text-is('{label}')").last
        return text.locator("xpath=ancestor::div[2]//*[self::input or self::textarea]").first


def picture(page: Page) -> Pixels:
    """What the page shows once it shows the same for a second."""
    before = page.pixels()
    for _ in range(60):
        page.tab.wait_for_timeout(1000)
        page.draw()
        now = page.pixels()
        if (now == before).all():
            return now
        before = now
    raise AssertionError("the picture does not come to rest")


def colors(pixels: Pixels) -> int:
    """How many colours fill at least a thousandth of a picture."""
    _, counts = np.unique(pixels.reshape(-1, 3), axis=0, return_counts=True)
    return int((counts > pixels.size / 3000).sum())


def test_a_display_is_added_by_topic_changed_saved_and_comes_back(
    start: Callable[..., Program], open_page: Callable[..., Page], tmp_path: Path
) -> None:
    config = tmp_path / "empty.yaml"
    config.write_text(EMPTY)
    start("webviz_sim")
    viewer = start("webviz", "--port", "0", "-d", str(config))
    page = open_page(viewer.url(), 1000, 700)
    hand = Hand(page)
    blank = picture(page)
    assert colors(blank) == 1

    hand.press("By topic")
    hand.tab.get_by_label("/map  ·  Map", exact=True).check()
    hand.press("Add")
    hand.sees("Map: 248 x 168 cells")
    page.wait_for(lambda: page.draw() or colors(page.pixels()) >= 3, "the map")
    added = picture(page)

    hand.choose("Color Scheme", "costmap")
    page.wait_for(lambda: (page.pixels() != added).mean() > 0.05, "the colours change")
    changed = picture(page)

    hand.press("Save as")
    hand.write("File name", "lab")
    hand.press("Save")
    hand.sees("Saved lab.yaml.")
    assert "color_scheme: costmap" in (tmp_path / "lab.yaml").read_text()
    assert config.read_text() == EMPTY
    page.tab.reload()
    page.wait_for(lambda: "Color Scheme" in page.text(), "the page is back")
    page.wait_for(lambda: (picture(page) == changed).all(), "the same picture", 60)
    assert viewer.end() == 0

    again = start("webviz", "--port", "0", "-d", str(tmp_path / "lab.yaml"))
    page = open_page(again.url(), 1000, 700)
    page.wait_for(lambda: "248 x 168 cells" in page.text(), "the map is there")
    page.wait_for(lambda: (picture(page) == changed).all(), "the same picture", 60)
