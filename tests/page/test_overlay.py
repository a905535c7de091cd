"""Overlays of the scene: axes, scale, legend, hover, rates."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest
from msgspec.structs import replace
from viser_internals import cut_connections

from tests.page.conftest import HEIGHT, WIDTH, Loop, Tab
from webviz.api.bridge import Bridge
from webviz.api.context import ColorScale
from webviz.api.nodes import Points, Pose
from webviz.engine.state import Row
from webviz.scene import ViserScene
from webviz.scene.server import Server

TURN = """async () => {
  const { controls } = await import("webviz/viser_page.js");
  return Math.sin(controls().azimuthAngle);
}"""
"""The direction of the camera, which the picture may not show yet: 1 from -Y."""
AXES = "async () => (await import('webviz/scene/view.js')).axes()"
CENTER = (700, 400)


@pytest.fixture(scope="module")
def scene(server: Server) -> ViserScene:
    return ViserScene(server)


@pytest.mark.parametrize(
    ("name", "axis", "toward"),
    [("X", 0, 1), ("-X", 0, -1), ("Y", 1, 1), ("-Y", 1, -1), ("Z", 2, 1)],
)
def test_the_axes_turn_the_view(tab: Tab, name: str, axis: int, toward: int) -> None:
    tab.page.get_by_role("button", name=f"Look from {name}", exact=True).dispatch_event("click")
    tab.wait_for(lambda: tab.page.evaluate(AXES)[axis][2] * toward > 0.999)


def test_the_keyboard_reaches_the_axes(tab: Tab) -> None:
    tab.page.get_by_role("button", name="Look from -Y", exact=True).focus()
    tab.page.keyboard.press("Enter")
    tab.wait_for(lambda: tab.page.evaluate(AXES)[1][2] < -0.999)


@pytest.mark.usefixtures("scene")  # it tells pages where to begin
def test_the_view_is_as_before_when_a_lost_connection_is_back(tab: Tab, server: Server) -> None:
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
    cut_connections(server)
    tab.wait_for(lambda: tab.page.evaluate("window.isBack"))
    assert tab.page.evaluate("window.turned") < 0.1
    tab.page.get_by_role("button", name="Look from X", exact=True).dispatch_event("click")
    tab.wait_for(lambda: tab.page.evaluate(AXES)[0][2] > 0.999)
    tab.wait_for(lambda: float(up.get_attribute("y2") or 0.0) < -25)


def test_the_scale_is_that_of_the_picture(tab: Tab) -> None:
    """Two points as far apart as the bar says are as far apart on the canvas as it is long."""
    tab.button("Look from Z").dispatch_event("click")
    tab.wait_for(lambda: tab.page.evaluate(AXES)[2][2] > 0.999)
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
    tab: Tab, loop: Loop, make_row: Callable[..., Row]
) -> None:
    scale = ColorScale("intensity", 2.16949, 97.5, ((255, 0, 0), (0, 0, 255)))
    loop.show(replace(make_row("a", "Scan <b>"), color_scale=scale), make_row("b"))
    legend = tab.page.locator(".wv-legend")
    tab.wait_for(lambda: legend.count() == 1)
    assert legend.inner_text().split("\n") == ["/scan", "2.169", "intensity", "97.5"]
    background = tab.page.locator(".wv-legend-bar").evaluate("e => e.style.background")
    assert background == "linear-gradient(to right, rgb(255, 0, 0), rgb(0, 0, 255))"
    loop.show(*(replace(make_row(one, f"Scan <{one}>"), color_scale=scale) for one in "ab"))
    titles = legend.locator(":scope > :first-child")
    tab.wait_for(lambda: titles.all_inner_texts() == ["/scan (Scan <a>)", "/scan (Scan <b>)"])
    loop.show(make_row("a"))
    tab.wait_for(lambda: legend.count() == 0)


def test_the_place_under_the_mouse_is_told(tab: Tab, loop: Loop) -> None:
    settings = replace(loop.state.settings, fixed_frame="odom")
    loop.show(settings=settings)
    tab.button("Look from Z").dispatch_event("click")
    tab.wait_for(lambda: tab.page.evaluate(AXES)[2][2] > 0.999)

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


def test_what_is_under_the_resting_mouse_is_named(
    tab: Tab, loop: Loop, scene: ViserScene, make_row: Callable[..., Row]
) -> None:
    grid = np.stack(np.meshgrid(np.linspace(-3, 3, 60), np.linspace(-3, 3, 60)), -1).reshape(-1, 2)
    xyz = np.column_stack((grid, np.full(len(grid), 0.25))).astype(np.float32)
    scene.upsert("display7/all/laser|", "points", Points(xyz, (255, 0, 0), 0.2, "square"), Pose())
    scene.flush()
    loop.show(make_row("display7", "Front scan"))
    tab.button("Look from Z").dispatch_event("click")
    hit = """async (xy) => {
      const { hit } = await import("webviz/scene/mouse.js");
      return Boolean(hit(xy)?.object);
    }"""
    tab.wait_for(lambda: tab.page.evaluate(hit, CENTER))
    tab.page.mouse.move(*CENTER)
    tab.wait_for(lambda: "Front scan: laser" in tab.text())
    assert "z 0.2" in tab.text()
    scene.remove_group("display7/all/laser|")
    scene.flush()


def test_the_hint_for_the_mouse_leaves_room_for_the_scale(tab: Tab) -> None:
    tab.page.set_viewport_size({"width": 820, "height": 600})
    scale = tab.page.locator(".wv-scale")
    tab.wait_for(scale.is_visible)
    hint, bar = tab.page.locator(".wv-pointer").bounding_box(), scale.bounding_box()
    assert hint is not None
    assert bar is not None
    assert hint["x"] + hint["width"] < bar["x"]
    tab.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})


def test_the_hint_goes_once_the_camera_was_moved_some_times(tab: Tab) -> None:
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


def test_rates_are_told_and_explained_on_a_click(tab: Tab) -> None:
    rates = tab.page.locator(".wv-rates")
    tab.wait_for(lambda: " ms" in rates.inner_text())
    assert " fps" in rates.inner_text()
    rates.click()
    assert "Round trip" in tab.text()
    rates.click()
    assert "Round trip" not in tab.text()


def test_the_page_says_what_is_reduced_because_of_a_slow_link(tab: Tab, server: Server) -> None:
    note = tab.page.locator(".wv-slow-link")
    congestion = server.channel.congestion(max(server.channel.browsers()))
    assert congestion is not None
    congestion.rate, congestion.every, congestion.shrink = 0.6e6, 8, 2
    tab.wait_for(note.is_visible)
    text = "Slow link, 4.8 Mbit/s: clouds show every 8th point, images at half size"
    assert note.text_content() == text
    congestion.rate, congestion.every, congestion.shrink = None, 1, 1
    tab.wait_for(note.is_hidden)


def test_the_page_names_its_bridge_and_says_when_it_is_not_live(tab: Tab, loop: Loop) -> None:
    card = tab.page.locator(".wv-bridge")
    assert card.count() == 0
    up = Bridge("ws://robot:8765", "Foxglove", is_up=True, was_up=True)
    loop.change(bridges=(up,))
    tab.wait_for(card.is_visible)
    assert card.text_content() == "ws://robot:8765"
    thinned = "The link carries 1.5 Mbit/s, so webviz thins /points to 0.13 Hz."
    loop.change(bridges=(dataclasses.replace(up, remarks=(thinned,)),))
    tab.wait_for(lambda: card.text_content() == f"ws://robot:8765 · {thinned}")
    problem = "Nothing listens on <b>robot</b>:8765."
    loop.change(bridges=(dataclasses.replace(up, is_up=False, problem=problem),))
    tab.wait_for(lambda: card.text_content() == "ws://robot:8765 · not live")
    assert card.get_attribute("data-tip") == problem
    fleet = [dataclasses.replace(up, robot=f"r{n}") for n in range(1, 11)]
    fleet[3] = dataclasses.replace(fleet[3], is_up=False, problem=problem)
    loop.change(bridges=tuple(fleet))
    tab.wait_for(lambda: card.all_text_contents() == ["9 robots connected", "r4 · not live"])
