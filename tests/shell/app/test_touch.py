"""Fingers on the scene, by the touch events of a real browser at the rate of a phone."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence

import playwright.sync_api as playwright
import pytest

import webviz
from webviz.files.opening import parse
from webviz.shell.app.picture_controls import checked_view
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.source import HandFedSource

CONFIG = """
fixed_frame: map
displays:
- {type: Grid}
- {type: Axes, reference_frame: map}
"""
SIZE = 390, 844
MIDDLE = 190.0, 420.0
STEPS = 24
REST_S = 0.5
VIEWS = (
    {"type": "Orbit", "distance": 10.0, "yaw": -math.pi / 2, "pitch": 0.8},
    {"type": "XYOrbit", "distance": 10.0, "yaw": -math.pi / 2, "pitch": 0.8},
    {"type": "TopDownOrtho", "scale": 30.0},
)
CAMERA = """async () => {
  const viser = await import("webviz/viser_page.js");
  const { toThree } = await import("webviz/scene/fixed_frame.js");
  const controls = viser.controls();
  const { distance, azimuthAngle: azimuth, polarAngle: polar } = controls;
  const target = controls.getTarget(viser.camera().position.clone());
  const [x, y] = target.applyMatrix4(toThree().clone().invert()).toArray();
  return { distance, azimuth, polar, x, y };
}"""

Point = tuple[float, float]


class Fingers:
    """Fingers on a page.

    Args:
        page: whose scene they touch.
    """

    def __init__(self, page: Page) -> None:
        self.page = page
        self._session = page.tab.context.new_cdp_session(page.tab)
        self._session.send("Emulation.setTouchEmulationEnabled", {"enabled": True})

    def send(self, kind: str, points: Sequence[Point]) -> None:
        touches = [{"x": x, "y": y, "id": at} for at, (x, y) in enumerate(points)]
        self._session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})

    def drag(self, before: Sequence[Point], after: Sequence[Point]) -> None:
        """Move fingers evenly over 0.4 s; they come down and leave one after the other.

        Before the last step they rest: viser's camera takes one move for a frame that it draws, and
        forgets those between the last frame and the lifting of a finger.
        """
        for count in range(1, len(before) + 1):
            self.send("touchStart", before[:count])
        for step in range(1, STEPS + 1):
            if step == STEPS:
                time.sleep(REST_S)
            self.send(
                "touchMove",
                [blend(*each, step / STEPS) for each in zip(before, after, strict=True)],
            )
            time.sleep(1 / 60)
        for count in reversed(range(len(after))):
            self.send("touchEnd", after[:count])


def blend(a: Point, b: Point, share: float) -> Point:
    return a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share


def beside(distance: float, middle: Point = MIDDLE) -> list[Point]:
    """Two fingers this far apart."""
    return [(middle[0] - distance / 2, middle[1]), (middle[0] + distance / 2, middle[1])]


@pytest.fixture(scope="module")
def viewer() -> Iterator[webviz.Viewer]:
    source = HandFedSource()
    with webviz.Viewer(port=0, source=source, read=lambda *_: parse(CONFIG, "x.yaml")) as viewer:
        yield viewer


@pytest.fixture(scope="module")
def fingers(browser: playwright.Browser, viewer: webviz.Viewer) -> Iterator[Fingers]:
    page = Page(browser, viewer.url, *SIZE, resolution=1.0)
    page.wait_for(lambda: page.tab.locator(".wv-toolbar").count(), "the page is there")
    for close in page.tab.get_by_role("button", name="Hide the panels").all():
        close.click()
    yield Fingers(page)
    errors = page.errors
    page.close()
    assert errors == []


def show(viewer: webviz.Viewer, fingers: Fingers, view: dict[str, object]) -> dict[str, float]:
    viewer.view = checked_view(view)
    fingers.page.tab.wait_for_timeout(500)
    return camera(fingers)


def camera(fingers: Fingers) -> dict[str, float]:
    return dict(fingers.page.evaluate(CAMERA))


@pytest.mark.parametrize("view", VIEWS, ids=lambda view: view["type"])
@pytest.mark.parametrize("factor", [4.0, 0.25])
def test_fingers_four_times_as_far_apart_make_everything_four_times_as_large(
    viewer: webviz.Viewer, fingers: Fingers, view: dict[str, object], factor: float
) -> None:
    before = show(viewer, fingers, view)
    far = 240.0
    pinch = beside(far / 4), beside(far)
    fingers.drag(*(pinch if factor > 1 else reversed(pinch)))
    fingers.page.tab.wait_for_timeout(300)
    after = camera(fingers)
    assert before["distance"] / after["distance"] == pytest.approx(factor, rel=0.02)
    turned = [after[name] - before[name] for name in ("azimuth", "polar")]
    assert turned == pytest.approx([0, 0], abs=0.02), "the finger that is left does not turn"


def test_two_fingers_pan_the_view(viewer: webviz.Viewer, fingers: Fingers) -> None:
    before = show(viewer, fingers, VIEWS[2])
    fingers.drag(beside(100), beside(100, (MIDDLE[0] + 60, MIDDLE[1] - 30)))
    fingers.page.tab.wait_for_timeout(500)
    new_place = {"x": before["x"] - 2.0, "y": before["y"] - 1.0}
    assert camera(fingers) == pytest.approx(before | new_place, abs=0.05)  # a pixel is 0.03 m


def test_one_finger_turns_as_the_mouse_does(viewer: webviz.Viewer, fingers: Fingers) -> None:
    before = show(viewer, fingers, VIEWS[0])
    fingers.drag([MIDDLE], [(MIDDLE[0] + 100, MIDDLE[1])])
    fingers.page.tab.wait_for_timeout(300)
    after = camera(fingers)
    assert before["azimuth"] - after["azimuth"] == pytest.approx(0.5, abs=0.03)
    assert after["distance"] == pytest.approx(before["distance"])
