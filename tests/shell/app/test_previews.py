"""Pictures of what tools draw over the scene while they are used."""

from __future__ import annotations

import io
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import PIL.Image
import playwright.sync_api as playwright
import pytest

import webviz
from tests.page.still_pages import FONT, HAS_FONT
from webviz.commands import SetToolProperty, ShowView
from webviz.files.opening import parse
from webviz.shell.app.picture_controls import checked_view
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.pictures import ReferenceImages
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import HandFedSource

CONFIG = """\
view: {type: Orbit, distance: 9, pitch: 0.6, yaw: -1.2}
displays:
- {type: Grid}
- {type: Axes, length: 2.0, radius: 0.25}
"""
STILL = f"""
  * {{ transition: none !important; font-family: "{FONT}", sans-serif !important }}
  .wv-toasts {{ visibility: hidden }}
"""
SIZE = 460, 320
"""Size of a picture, in the middle of the scene."""
TOLERANCE = 0.001
"""Share of pixels that may differ: an arrow moved by a pixel is more."""


@pytest.fixture(scope="module")
def viewer() -> Iterator[webviz.Viewer]:
    source = HandFedSource(graph=RememberingGraph())  # pyright: ignore[reportArgumentType]
    with webviz.Viewer(port=0, source=source, read=lambda *_: parse(CONFIG, "x.yaml")) as viewer:
        yield viewer


@pytest.fixture(scope="module")
def page(browser: playwright.Browser, viewer: webviz.Viewer) -> Iterator[Page]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(browser, "new_context", partial(browser.new_context, smooth=True))  # pyright: ignore[reportCallIssue]
        page = Page(browser, viewer.url, 900, 600)
    if not page.tab.evaluate(HAS_FONT):
        pytest.skip(f"needs the font {FONT}: install fonts-dejavu-core")
    page.tab.emulate_media(color_scheme="dark")
    page.tab.add_style_tag(content=STILL)
    buttons = page.tab.locator(".wv-tools [aria-label='2D Goal Pose']")
    page.wait_for(lambda: buttons.count() == 1, "the toolbar")
    page.tab.evaluate("document.querySelectorAll('.wv-first-run').forEach((one) => one.remove())")
    page.tab.keyboard.press("Control+b")  # no panels
    page.wait_for(lambda: middle(page)[0] == 450.0, "a scene as wide as the window")
    page.draw()
    yield page
    assert page.errors == []
    page.close()


@pytest.fixture
def references(request: pytest.FixtureRequest) -> ReferenceImages:
    root = request.config.rootpath
    update = bool(request.config.getoption("--update-pictures"))
    return ReferenceImages(Path(__file__).parent / "pictures", root / "tests/output", root, update)


def capture(page: Page) -> np.ndarray:
    """The middle of the scene once nothing moves: two equal pictures in a row."""
    x, y = middle(page)
    width, height = SIZE
    clip = playwright.FloatRect(x=x - width / 2, y=y - height / 2, width=width, height=height)
    pictures: list[bytes] = []

    def is_still() -> bool:
        pictures.append(page.tab.screenshot(clip=clip))
        return pictures[-2:-1] == pictures[-1:]

    page.wait_for(is_still, "a picture that stands still")
    with PIL.Image.open(io.BytesIO(pictures[-1])) as image:
        return np.asarray(image.convert("RGB"))


def middle(page: Page) -> tuple[float, float]:
    left, top, width, height = page.tab.evaluate(
        "(() => { const b = window.__viserMutable.canvas.getBoundingClientRect();"
        "return [b.left, b.top, b.width, b.height]; })()"
    )
    return left + width / 2, top + height / 2


def press(page: Page, key: str, *path: tuple[float, float]) -> None:
    """Begin a gesture of a tool along a path, in pixels from the middle of the scene."""
    (x, y), mouse = middle(page), page.tab.mouse
    page.tab.keyboard.press(key)
    mouse.move(x + path[0][0], y + path[0][1])
    mouse.down()
    for dx, dy in path[1:]:
        mouse.move(x + dx, y + dy, steps=3)


def leave(page: Page) -> None:
    page.tab.keyboard.press("Escape")
    page.tab.mouse.up()


def test_the_preview_of_a_pose_is_where_the_pose_will_be(
    page: Page, references: ReferenceImages
) -> None:
    press(page, "g", (-60.0, 60.0), (40.0, 90.0))
    references.check("pose", capture(page), tolerance=TOLERANCE)
    page.tab.keyboard.down("Control")
    x, y = middle(page)
    page.tab.mouse.move(x + 40.0, y + 20.0, steps=3)
    page.tab.keyboard.up("Control")
    references.check("pose_lifted", capture(page), tolerance=TOLERANCE)
    leave(page)


def test_a_pose_that_waits_can_be_sent_or_cancelled(
    page: Page, viewer: webviz.Viewer, references: ReferenceImages
) -> None:
    viewer.do(SetToolProperty("2D Pose Estimate", "confirm", True))
    knows = "async () => (await import('webviz/tools/registry.js')).all().some((one) => one.asks)"
    page.wait_for(lambda: page.tab.evaluate(knows), "the tool that asks")
    press(page, "p", (-60.0, 40.0), (40.0, 70.0))
    page.tab.mouse.up()
    x, y = middle(page)
    page.tab.mouse.move(x + 300.0, y)
    references.check("pose_waiting", capture(page), tolerance=TOLERANCE)
    leave(page)


def test_a_point_is_on_the_surface_and_lines_measure_between_surfaces(
    page: Page, references: ReferenceImages
) -> None:
    press(page, "u", (60.0, 5.0))
    references.check("point", capture(page), tolerance=TOLERANCE)
    leave(page)
    (x, y), mouse = middle(page), page.tab.mouse
    page.tab.keyboard.press("n")
    for dx, dy in ((-150.0, 80.0), (60.0, 5.0), (-20.0, 130.0), (170.0, 90.0)):
        mouse.click(x + dx, y + dy)
    mouse.move(x + 300.0, y)
    references.check("measure", capture(page), tolerance=TOLERANCE)
    mouse.click(x, y, button="right")
    leave(page)


def test_seen_from_above_the_preview_is_exact_to_the_pixel(
    page: Page, viewer: webviz.Viewer
) -> None:
    viewer.do(ShowView(checked_view({"type": "TopDownOrtho", "scale": 50})))
    page.draw()
    press(page, "g", (100.0, 50.0), (180.0, 50.0))
    page.draw()
    dot = page.tab.locator(".wv-preview-start").bounding_box()
    corners = page.tab.locator(".wv-preview-arrow").get_attribute("points") or ""
    leave(page)
    assert dot is not None
    x, y = middle(page)
    at = dot["x"] + dot["width"] / 2, dot["y"] + dot["height"] / 2
    assert at == pytest.approx((x + 100.0, y + 50.0), abs=0.5)
    # RViz's arrow is 2.5 m long and points to where the pointer is.
    arrow = np.array([corner.split(",") for corner in corners.split()], float)
    assert np.ptp(arrow, axis=0)[0] == pytest.approx(2.5 * 50.0, abs=0.5)
    tail = arrow[[0, -1]].mean(axis=0)
    assert arrow[3] - tail == pytest.approx([2.5 * 50.0, 0.0], abs=0.5)
