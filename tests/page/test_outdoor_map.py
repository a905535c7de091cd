"""The panel Outdoor map in a real browser: its tiles, its track, and how it is moved."""

from __future__ import annotations

import io
from pathlib import Path

import PIL.Image
import pytest
from pages import bounds

from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from tests.page.test_daily_panels import subscribe
from tests.page.test_daily_panels import tab as tab
from webviz.api.declared import make
from webviz.data.geo import Geodetic, TilePlane
from webviz.panels.outdoor_map import FIX, OutdoorMap

HERE = Geodetic(50.0, 8.0)
LEVEL = 17
GREEN = (60, 160, 90)


@pytest.fixture
def tiles(tmp_path: Path) -> Path:
    """Tiles around HERE, as files."""
    buffer = io.BytesIO()
    PIL.Image.new("RGB", (8, 8), GREEN).save(buffer, "PNG")
    for x, y in TilePlane(HERE, LEVEL).around(3):
        path = tmp_path / f"{LEVEL}/{x}/{y}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(buffer.getvalue())
    return tmp_path


def publish(viewer: PageBench, latitude: float, longitude: float) -> None:
    """Have the receiver report a place."""
    viewer.publish("/fix", FIX, {"latitude": latitude, "longitude": longitude})
    viewer.turn()


def color(tab: ViewerTab, dx: int = 0, dy: int = 0) -> tuple[int, ...]:
    """RGBA of the map this far from its middle, in pixels."""
    script = """(canvas, [dx, dy]) => {
      const { width, height } = canvas;
      const place = [Math.floor(width / 2) + dx, Math.floor(height / 2) + dy, 1, 1];
      return [...canvas.getContext("2d").getImageData(...place).data];
    }"""
    return tuple(tab.page.locator(".wv-outdoor canvas").evaluate(script, [dx, dy]))


def test_the_track_lies_on_the_tiles_and_the_map_follows_it(
    viewer: PageBench, tab: ViewerTab, tiles: Path
) -> None:
    subscribe(tab, make(OutdoorMap, {"object_uri": str(tiles)}), fix=FIX)
    tab.wait_for(lambda: "No place yet on /fix." in tab.text())
    for i in range(21):
        publish(viewer, 50.0, 7.999 + i / 20_000)
    tab.wait_for(lambda: color(tab, 0, 60) == (*GREEN, 255))
    track = color(tab)
    assert track != (*GREEN, 255)
    assert color(tab, -40) == track
    assert color(tab, 40) == (*GREEN, 255)
    publish(viewer, 50.0, 8.001)
    tab.wait_for(lambda: color(tab, -80) == track)
    box = bounds(tab.page.locator(".wv-outdoor canvas"))
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    tab.page.mouse.move(x, y)
    there = tab.page.locator(".wv-outdoor-place")
    tab.wait_for(there.is_visible)

    def place() -> list[float]:
        return [float(each) for each in there.inner_text().replace("°", "").split(", ")]

    tab.wait_for(lambda: place() == pytest.approx([50.0, 8.001], abs=2e-5))  # two pixels
    tab.page.mouse.down()
    tab.page.mouse.move(x, y + 50, steps=3)
    tab.page.mouse.up()
    tab.wait_for(lambda: color(tab, 0, 50) == track and color(tab) == (*GREEN, 255))
    tab.button("Follow the newest fix (0)").click()
    tab.wait_for(lambda: color(tab) == track)
    tab.button("Zoom in (+)").click()  # shows parts of the tiles above
    tab.wait_for(lambda: "level 18" in (canvas_label(tab) or ""))
    assert color(tab, 0, 60) == (*GREEN, 255)


def canvas_label(tab: ViewerTab) -> str | None:
    return tab.page.locator(".wv-outdoor canvas").get_attribute("aria-label")
