"""Overlays of the scene: axes, scale, legend, hover, rates."""

from __future__ import annotations

import dataclasses
import time

import pytest
from pages import bounds
from playwright.sync_api import expect
from viser_internals import cut_connections

from tests.page.everything import named
from tests.page.page_bench import SCAN, PageBench
from tests.page.tabs import HEIGHT, WIDTH, ViewerTab
from webviz.api.bridge import Bridge
from webviz.shell.testing.messages import header, stamped_transform
from webviz_displays.axes import Axes
from webviz_displays.laser_scan import LaserScan

TURN = """async () => {
  const { controls } = await import("webviz/viser_page.js");
  return Math.sin(controls().azimuthAngle);
}"""
"""The direction of the camera, which the picture may not show yet: 1 from -Y."""
AXES = "async () => (await import('webviz/scene/view.js')).axes()"
CENTER = (700, 400)


@pytest.fixture
def tab(viewer_tab: ViewerTab) -> ViewerTab:
    return viewer_tab


def publish_scan(viewer: PageBench, *intensities: float) -> None:
    """Publish a scan whose beams hit something a metre away."""
    ranges = [1.0 for _ in intensities]
    scan = {"header": header("map", viewer.source.now), "range_max": 100.0, "ranges": ranges}
    viewer.publish("/scan", SCAN, {**scan, "intensities": intensities})
    viewer.turn()


@pytest.mark.parametrize(
    ("name", "axis", "toward"),
    [("X", 0, 1), ("-X", 0, -1), ("Y", 1, 1), ("-Y", 1, -1), ("Z", 2, 1)],
)
def test_the_axes_turn_the_view(tab: ViewerTab, name: str, axis: int, toward: int) -> None:
    tab.page.get_by_role("button", name=f"Look from {name}", exact=True).dispatch_event("click")
    tab.wait_for(lambda: tab.page.evaluate(AXES)[axis][2] * toward > 0.999)


def test_the_keyboard_reaches_the_axes(tab: ViewerTab) -> None:
    tab.page.get_by_role("button", name="Look from -Y", exact=True).focus()
    tab.page.keyboard.press("Enter")
    tab.wait_for(lambda: tab.page.evaluate(AXES)[1][2] < -0.999)


def test_the_view_is_as_before_when_a_lost_connection_is_back(tab: ViewerTab) -> None:
    tab.wait_for(lambda: tab.page.evaluate("window.webviz.hasView()"))
    tab.page.get_by_role("button", name="Look from -Y", exact=True).dispatch_event("click")
    tab.wait_for(lambda: tab.page.evaluate(TURN) > 0.9999)
    up = tab.page.locator(".wv-gizmo [data-axis=z][data-side=front] line")
    tab.wait_for(lambda: float(up.get_attribute("y2") or 0.0) < -25)
    tab.page.evaluate(
        """async () => {
          const viser = await import("webviz/viser_page.js");
          const { on } = await import("webviz/channel.js");
          const before = viser.controls().azimuthAngle;
          window.turned = 0;
          (function look() {
            const turned = Math.abs(viser.controls().azimuthAngle - before);
            window.turned = Math.max(window.turned, turned);
            if (!window.isBack) requestAnimationFrame(look);
          })();
          on("StartView", () => { window.isBack = true; });
        }"""
    )
    cut_connections(tab.viewer.server)
    tab.wait_for(lambda: tab.page.evaluate("window.isBack"))
    assert tab.page.evaluate("window.turned") < 0.1
    tab.page.get_by_role("button", name="Look from X", exact=True).dispatch_event("click")
    tab.wait_for(lambda: tab.page.evaluate(AXES)[0][2] > 0.999)
    tab.wait_for(lambda: float(up.get_attribute("y2") or 0.0) < -25)


def look_from_above(tab: ViewerTab) -> None:
    """Click on the axis until it is followed: the view of a config may come after a first click."""
    due_s = 0.0

    def is_above() -> bool:
        nonlocal due_s
        if time.monotonic() > due_s:
            due_s = time.monotonic() + 3.0
            tab.button("Look from Z").dispatch_event("click")
        return tab.page.evaluate(AXES)[2][2] > 0.999

    tab.wait_for(is_above)


def test_the_scale_is_that_of_the_picture(tab: ViewerTab) -> None:
    """Two points as far apart as the bar says are as far apart on the canvas as it is long."""
    look_from_above(tab)
    bar = tab.page.locator(".wv-scale")
    words, pixels = bar.inner_text(), tab.page.locator(".wv-scale-line").bounding_box()
    number, unit = words.split()
    meters = float(number) * {"km": 1e3, "m": 1.0, "cm": 0.01}[unit]
    across = tab.page.evaluate(
        """async (meters) => {
          const { onCanvas } = await import('webviz/scene/ground.js');
          const [from, to] = [onCanvas([0, 0, 0]), onCanvas([meters, 0, 0])];
          return Math.hypot(to[0] - from[0], to[1] - from[1]);
        }""",
        meters,
    )
    assert pixels is not None
    assert pixels["width"] == pytest.approx(across, abs=3.0)


def test_legends_say_what_colors_stand_for_and_of_which_topic(
    viewer: PageBench, tab: ViewerTab
) -> None:
    def scan(name: str) -> LaserScan:
        red, blue = (255, 0, 0), (0, 0, 255)
        return LaserScan(name=name, use_rainbow=False, min_color=red, max_color=blue)

    viewer.show(scan("Scan <b>"), *named("b"))
    publish_scan(viewer, 2.16949, 97.5, 50.0)
    legend = tab.page.locator(".wv-legend")
    tab.wait_for(lambda: legend.count() == 1)
    assert legend.inner_text().split("\n") == ["/scan", "2.169", "intensity", "97.5"]
    background = tab.page.locator(".wv-legend-bar").evaluate("e => e.style.background")
    assert background == "linear-gradient(to right, rgb(255, 0, 0), rgb(0, 0, 255))"
    viewer.show(scan("Scan <a>"), scan("Scan <b>"))
    publish_scan(viewer, 2.16949, 97.5, 50.0)
    titles = legend.locator(":scope > :first-child")
    tab.wait_for(lambda: titles.all_inner_texts() == ["/scan (Scan <a>)", "/scan (Scan <b>)"])
    viewer.show(*named("a"))
    tab.wait_for(lambda: legend.count() == 0)


def test_the_place_under_the_mouse_is_told(viewer: PageBench, tab: ViewerTab) -> None:
    viewer.show(fixed_frame="odom")
    look_from_above(tab)

    def is_pointed_at() -> bool:
        place = tab.page.evaluate(
            """async () => {
              const { onCanvas } = await import('webviz/scene/ground.js');
              const box = document.querySelector('canvas').getBoundingClientRect();
              const [x, y] = onCanvas([-1, 0.5, 0]);
              return [box.left + x, box.top + y];
            }"""
        )
        tab.page.mouse.move(*place)  # the camera may still turn a little
        return "x -1.0" in tab.text() or "x -0.99" in tab.text()

    tab.wait_for(is_pointed_at)
    assert "m · odom" in tab.text()
    tab.page.mouse.move(5, 5)
    tab.wait_for(lambda: "Left: turn" in tab.text())


def test_what_is_under_the_resting_mouse_is_named(viewer: PageBench, tab: ViewerTab) -> None:
    lidar = stamped_transform("map", "lidar", 0, (0.0, 0.0, 0.25))
    viewer.publish("/tf_static", "tf2_msgs/msg/TFMessage", {"transforms": [lidar]})
    viewer.show(Axes(name="Front <b>", reference_frame="lidar", length=2.0, radius=1.0))
    look_from_above(tab)
    hit = """async (xy) => {
      const { hit } = await import("webviz/scene/mouse.js");
      return Boolean(hit(xy)?.object);
    }"""
    tab.wait_for(lambda: tab.page.evaluate(hit, CENTER))
    words = tab.page.locator(".wv-pointer")
    with tab.paused():
        tab.page.mouse.move(*CENTER)
        expect(words).to_contain_text("z 2.25 m · map · Front <b>: lidar")  # not answered yet
    answer = "z 2.25 m · map · Front <b> · Axes of lidar"
    tab.wait_for(lambda: answer in words.inner_text())


def test_the_hint_for_the_mouse_leaves_room_for_the_scale(tab: ViewerTab) -> None:
    tab.page.set_viewport_size({"width": 820, "height": 600})
    scale = tab.page.locator(".wv-scale")
    tab.wait_for(scale.is_visible)
    hint, bar = bounds(tab.page.locator(".wv-pointer")), bounds(scale)
    assert hint["x"] + hint["width"] < bar["x"]
    tab.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})


def test_the_hint_goes_once_the_camera_was_moved_some_times(tab: ViewerTab) -> None:
    hint = tab.page.locator(".wv-pointer")
    forget = "localStorage.removeItem('webviz.camera-moves')"
    tab.page.evaluate(forget)
    tab.page.mouse.move(WIDTH - 5, 20)
    tab.page.mouse.move(5, HEIGHT // 2)  # off the scene
    tab.wait_for(lambda: "Left: turn" in hint.inner_text())
    tab.page.mouse.move(*CENTER)
    for _ in range(5):
        tab.page.mouse.wheel(0, 1)
    tab.page.mouse.move(5, HEIGHT // 2)
    tab.wait_for(lambda: hint.inner_text() == "")
    tab.page.evaluate(forget)


def test_rates_are_told_and_explained_on_a_click(tab: ViewerTab) -> None:
    rates = tab.page.locator(".wv-rates")
    tab.wait_for(lambda: " ms" in rates.inner_text())
    assert " fps" in rates.inner_text()
    rates.click()
    assert "Round trip" in tab.text()
    rates.click()
    assert "Round trip" not in tab.text()


def test_the_page_says_what_is_reduced_because_of_a_slow_link(tab: ViewerTab) -> None:
    note = tab.page.locator(".wv-slow-link")
    congestion = tab.viewer.server.channel.congestion(tab.browser)
    assert congestion is not None
    congestion.rate, congestion.every, congestion.shrink = 0.6e6, 8, 2
    tab.wait_for(note.is_visible)
    text = "Slow link, 4.8 Mbit/s: clouds show every 8th point, images at half size"
    assert note.text_content() == text
    congestion.rate, congestion.every, congestion.shrink = None, 1, 1
    tab.wait_for(note.is_hidden)


def test_the_page_names_its_bridge_and_says_when_it_is_not_live(
    viewer: PageBench, tab: ViewerTab
) -> None:
    card = tab.page.locator(".wv-bridge")
    assert card.count() == 0
    up = Bridge("ws://robot:8765", "Foxglove", is_up=True, was_up=True)
    viewer.source.bridges = (up,)
    tab.wait_for(card.is_visible)
    assert card.text_content() == "ws://robot:8765"
    thinned = "The link carries 1.5 Mbit/s, so webviz thins /points to 0.13 Hz."
    viewer.source.bridges = (dataclasses.replace(up, remarks=(thinned,)),)
    tab.wait_for(lambda: card.text_content() == f"ws://robot:8765 · {thinned}")
    problem = "Nothing listens on <b>robot</b>:8765."
    viewer.source.bridges = (dataclasses.replace(up, is_up=False, problem=problem),)
    tab.wait_for(lambda: card.text_content() == "ws://robot:8765 · not live")
    assert card.get_attribute("data-tip") == problem
    fleet = [dataclasses.replace(up, robot=f"r{n}") for n in range(1, 11)]
    fleet[3] = dataclasses.replace(fleet[3], is_up=False, problem=problem)
    viewer.source.bridges = tuple(fleet)
    tab.wait_for(lambda: card.all_text_contents() == ["9 robots connected", "r4 · not live"])
