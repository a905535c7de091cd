"""A display of one's own in a real browser, over DDS, while its file is edited."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import playwright.sync_api as playwright
import pytest

import webviz
from tests.features.plugins.conftest import Plugin
from webviz.shell.pictures.browser import Page

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

import rclpy
from geometry_msgs.msg import Point32, PolygonStamped
from rclpy.context import Context
from rclpy.node import Node

CONFIG = """\
fixed_frame: map
view: {distance: 8.0, yaw: -1.570796, pitch: 1.5697}
displays:
- {type: Area, name: Fence}
"""
CORNERS = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
GREEN, MAGENTA = (25, 255, 0), (255, 0, 255)


@pytest.fixture
def page(
    plugin: Plugin, webviz_domain: int, tmp_path: Path, browser: playwright.Browser
) -> Iterator[Page]:
    """Open the page of a viewer with the plug-in."""
    config = tmp_path / "fence.yaml"
    config.write_text(CONFIG)
    with webviz.Viewer(config, port=0, plugins=[plugin.path]) as viewer:
        page = Page(browser, viewer.url, 900, 500)
        page.hold()
        yield page
        page.close()
    assert page.errors == []


@pytest.fixture
def publish(webviz_domain: int) -> Iterator[Callable[[], None]]:
    """Publish the polygon once."""
    context = Context()
    rclpy.init(context=context, domain_id=webviz_domain)
    node = Node("fence", context=context)
    publisher = node.create_publisher(PolygonStamped, "/polygon", 1)
    message = PolygonStamped()
    message.header.frame_id = "map"
    message.polygon.points = [Point32(x=x, y=y) for x, y in CORNERS]
    yield lambda: publisher.publish(message)
    node.destroy_node()
    context.shutdown()


def is_drawn(page: Page, rgb: tuple[int, int, int]) -> bool:
    """Return whether the middle of every edge of the polygon has a colour."""
    page.draw()
    pixels = page.pixels().astype(int)
    for (x1, y1), (x2, y2) in zip(CORNERS, CORNERS[1:] + CORNERS[:1], strict=True):
        column, row = np.round(page.pixel_of((x1 + x2) / 2, (y1 + y2) / 2)).astype(int)
        patch = pixels[row - 2 : row + 3, column - 2 : column + 3]
        # A line on the border of two pixels is half in each.
        if not (np.abs(patch - rgb).max(axis=2) < 130).any():
            return False
    return True


def test_the_picture_follows_the_file_on_every_save(
    page: Page, plugin: Plugin, publish: Callable[[], None], caplog: pytest.LogCaptureFixture
) -> None:
    def published_and_drawn() -> bool:
        publish()
        return is_drawn(page, GREEN)

    page.wait_for(published_and_drawn, "the outline in the colour of the file")
    # From here on nothing is published: what was heard is drawn anew.
    plugin.edit(("= (25, 255, 0)", "= (255, 0, 255)"))
    page.wait_for(lambda: is_drawn(page, MAGENTA), "the outline in the new colour")
    plugin.edit(("def draw(self", "def draw(self("))
    sentence = "is not valid Python"
    page.wait_for(lambda: sentence in caplog.text, "the mistake in the log")
    page.wait_for(lambda: sentence in page.text(), "the mistake in the panel")
    assert is_drawn(page, MAGENTA)
    plugin.edit(("def draw(self(", "def draw(self"), ("Colour of the", "Paint of the"))
    page.wait_for(lambda: sentence not in page.text(), "a panel without complaint")
    assert is_drawn(page, MAGENTA)
    assert "Traceback" not in caplog.text
