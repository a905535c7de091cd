"""Images in panes of a page, as tests publish and read them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import photos
import playwright.sync_api as playwright
from numpy.typing import NDArray
from pages import bounds

from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.api.declared import Topic
from webviz.files.config.model import MemorySettings
from webviz.shell.testing.messages import header
from webviz_displays.image import Image

COLORS, DEPTHS = photos.room(160, 120)
FORGETFUL = MemorySettings(seconds=0.0)
"""No memory, and thereby no timeline, which would narrow the room of images."""
VIDEO = "foxglove_msgs/msg/CompressedVideo"


@contextmanager
def images_in(viewer: PageBench, tab: ViewerTab) -> Iterator[Any]:
    """A tab with two images, which are gone afterwards."""
    show_images(viewer)
    tab.wait_for(lambda: pane_color(tab, "Color") and pane_color(tab, "Depth"))
    yield tab
    viewer.show()
    tab.wait_for(lambda: tab.page.locator(".wv-pane").count() == 0)


def show_images(viewer: PageBench, colors: str = photos.RAW) -> None:
    """Show colours and depths.

    Args:
        viewer: that shows them.
        colors: type of the messages with colours, of which there is one unless it is another.
    """
    viewer.offer("/color", colors, "/camera")
    viewer.offer("/depth", photos.RAW, "/camera")
    tone = {"normalize_range": False, "min_value": 0.5, "max_value": 4.0, "color_map": "Turbo"}
    viewer.show(image("/color"), image("/depth", **tone), memory=FORGETFUL)
    viewer.turn()
    if colors == photos.RAW:
        publish(viewer, "Color", COLORS, "rgb8")
    publish(viewer, "Depth", DEPTHS, "32FC1")


def image(topic: str, name: str = "Image", **properties: Any) -> Image:
    """A display of the images of a topic."""
    return Image(name=name, topic=Topic(topic), **properties)


def publish(viewer: PageBench, name: str, values: NDArray[Any], encoding: str) -> None:
    """Publish a raw image."""
    send(viewer, name, photos.RAW, photos.raw(values, encoding))


def send(viewer: PageBench, name: str, type_: str, message: dict[str, Any]) -> None:
    """Publish an image of any kind."""
    viewer.pass_time(0.02)
    stamped = {} if type_ == VIDEO else {"header": header("camera", viewer.source.now)}
    viewer.publish(f"/{name.lower()}", type_, message | stamped)
    viewer.turn()


def id_of(viewer: PageBench, name: str) -> str:
    """The id of the display of an image."""
    topics = viewer.values("topic.name")
    return viewer.rows[topics.index(f"/{name.lower()}")].id


def pane(tab: ViewerTab, name: str) -> playwright.Locator:
    return tab.page.get_by_label(f"Image /{name.lower()}", exact=True)


def pane_color(tab: ViewerTab, name: str, at: tuple[float, float] = (0.5, 0.9)) -> list[int]:
    """The colour of a place in a picture, empty as long as there is none."""
    script = """(pane, [x, y]) => {
      const canvas = pane.querySelector("canvas");
      if (!pane.dataset.stamp) return [];
      const place = [Math.floor(x * canvas.width), Math.floor(y * canvas.height), 1, 1];
      const context = canvas.getContext("2d", { willReadFrequently: true });
      return [...context.getImageData(...place).data.slice(0, 3)];
    }"""
    return pane(tab, name).evaluate(script, list(at)) if pane(tab, name).count() else []


def near(color: list[int], expected: Any, tolerance: int = 12) -> bool:
    return len(color) == 3 and bool(np.abs(np.subtract(color, expected)).max() <= tolerance)


def hover(tab: ViewerTab, name: str, x: float, y: float) -> str:
    box = bounds(pane(tab, name).locator(".wv-pane-picture"))
    scale = min(box["width"] / 160, box["height"] / 120)
    left = box["x"] + (box["width"] - 160 * scale) / 2 + (x + 0.5) * scale
    top = box["y"] + (box["height"] - 120 * scale) / 2 + (y + 0.5) * scale
    tab.page.mouse.move(left, top)
    return pane(tab, name).locator(".wv-pane-value").inner_text()


def middle(tab: ViewerTab) -> tuple[float, float]:
    """The middle of the pane of the picture "Color" in the window."""
    box = bounds(pane(tab, "Color").locator(".wv-pane-body"))
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def rgba(red: float, green: float, blue: float) -> dict[str, float]:
    return {"r": red, "g": green, "b": blue, "a": 1.0}
