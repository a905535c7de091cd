"""The panel 3D scene in a real browser: what its own camera sees, and how it is moved."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import msgspec
import playwright.sync_api as playwright
import pytest
from pages import bounds

import webviz
from webviz.commands import AddPanel, RemovePanel, SetPanelProperty, Undo
from webviz.data.messages import encode
from webviz.files.opening import parse
from webviz.panels.scene_view import SceneCamera
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import HandFedSource

CONFIG = """
fixed_frame: map
background: [0, 0, 0]
displays:
- {type: Axes, name: Axes, length: 4, radius: 0.5, reference_frame: map}
panels:
- {type: SceneView, view: {type: TopDownOrtho, yaw: -1.5707963, distance: 12}}
layout: {below: [{panel: SceneView}], height: 260}
"""
SIZE = 800, 640
"""Size of the window in pixels."""
CANVAS = ".wv-scene-view canvas"
HALF_VIEW = math.tan(math.pi / 8)
POSITION = """async () => {
  const viser = await import("webviz/viser_page.js");
  return viser.camera().position.toArray();
}"""
"""Position of the camera of the main scene."""
TF = "tf2_msgs/msg/TFMessage"


@pytest.fixture(scope="module")
def source() -> HandFedSource:
    return HandFedSource()


@pytest.fixture
def viewer(source: HandFedSource) -> Iterator[webviz.Viewer]:
    with webviz.Viewer(port=0, source=source, read=lambda *_: parse(CONFIG, "x.yaml")) as viewer:
        yield viewer


@pytest.fixture
def page(browser: playwright.Browser, viewer: webviz.Viewer) -> Iterator[Page]:
    page = Page(browser, viewer.url, *SIZE, resolution=1.0)
    page.wait_for(lambda: page.tab.locator(CANVAS).count() == 1, "the panel is there")
    yield page
    errors = page.errors
    page.close()
    assert errors == []


def color(page: Page, x_m: float, y_m: float, distance: float = 12.0) -> str:
    """The strongest colour at a place of the ground, seen from the top: "r", "g", "b" or ""."""
    script = """(canvas, [x, y, height]) => {
      const { width, height: tall } = canvas;
      const [across, down] = [width / 2 + (x * tall) / height, tall / 2 - (y * tall) / height];
      return [...canvas.getContext("2d").getImageData(across, down, 1, 1).data];
    }"""
    page.draw(1)
    height = 2 * distance * HALF_VIEW
    rgba = page.tab.locator(CANVAS).evaluate(script, [x_m, y_m, height])
    strong = [each for each, value in zip("rgb", rgba, strict=False) if value > 60]
    return strong[0] if len(strong) == 1 else ""


def camera_of(viewer: webviz.Viewer) -> dict[str, Any]:
    """The camera of the panel as a config file has it."""
    (panel,) = viewer.config["panels"]
    return msgspec.to_builtins(SceneCamera()) | dict(panel.get("view", {}))


def middle(page: Page) -> tuple[float, float]:
    box = bounds(page.tab.locator(CANVAS))
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def drag(page: Page, dx: float, dy: float, button: Any = "left") -> None:
    x, y = middle(page)
    mouse = page.tab.mouse
    mouse.move(x, y)
    mouse.down(button=button)
    mouse.move(x + dx / 2, y + dy / 2)
    mouse.move(x + dx, y + dy)
    mouse.up(button=button)


def test_it_has_its_own_camera_and_hides_chosen_displays(viewer: webviz.Viewer, page: Page) -> None:
    page.wait_for(lambda: color(page, 2, 0) == "r" and color(page, 0, 2) == "g", "axes are there")
    assert color(page, -2, 0) == color(page, 0, -2) == color(page, 5, 0) == ""
    viewer.do(SetPanelProperty("3D scene", "displays", {"Axes": False}))
    page.wait_for(lambda: color(page, 2, 0) == "", "the axes are left out")
    head = page.tab.locator(".wv-docked-head", has_text="3D scene")
    head.get_by_text("1 hidden").wait_for()
    assert page.pixels().max() > 100, "the main scene has them"
    viewer.do(Undo())
    page.wait_for(lambda: color(page, 2, 0) == "r", "they are there again")


def test_its_camera_is_moved_by_the_mouse_and_kept_with_undo(
    viewer: webviz.Viewer, page: Page
) -> None:
    page.wait_for(lambda: color(page, 2, 0) == "r", "axes are there")
    before = page.evaluate(POSITION)
    drag(page, 100 * math.pi, 0)  # a quarter turn
    page.wait_for(
        lambda: camera_of(viewer)["yaw"] == pytest.approx(-math.pi, abs=1e-3), "it turned"
    )
    assert color(page, 0, 2) == "r", "x points up"
    assert page.evaluate(POSITION) == before, "the main scene stays"
    viewer.do(Undo())
    page.wait_for(lambda: color(page, 2, 0) == "r", "it is back")
    height = page.tab.locator(CANVAS).evaluate("canvas => canvas.clientHeight")
    meter = height / (24 * HALF_VIEW)
    drag(page, -2 * meter, -meter, "middle")
    page.wait_for(
        lambda: camera_of(viewer)["focal_point"] == pytest.approx([2, -1, 0], abs=0.05), "it moved"
    )
    assert color(page, -2, 1) == "b", "the middle of the axes, seen along z"
    page.tab.mouse.move(*middle(page))
    page.tab.mouse.wheel(0, -120)
    page.wait_for(lambda: camera_of(viewer)["distance"] == pytest.approx(12 * 0.88), "it is closer")
    x, y = middle(page)
    meter /= 0.88
    page.tab.mouse.dblclick(x - 2 * meter, y - meter)
    page.wait_for(
        lambda: camera_of(viewer)["focal_point"] == pytest.approx([0, 0, 0], abs=0.05),
        "it looks at",
    )


def test_it_follows_its_frame_without_its_turns(
    viewer: webviz.Viewer, source: HandFedSource, page: Page
) -> None:
    page.wait_for(lambda: color(page, 2, 0) == "r", "axes are there")
    viewer.do(SetPanelProperty("3D scene", "view.target_frame", "base"))

    def move(x_m: float) -> None:
        source.now += 1_000_000_000
        turned = {"z": math.sqrt(0.5), "w": math.sqrt(0.5)}
        pose = {"translation": {"x": x_m}, "rotation": turned}
        one = {"header": header("map", source.now), "child_frame_id": "base", "transform": pose}
        source.put("/tf", TF, encode(TF, {"transforms": [one]}))

    for x_m in (1.0, -2.0):
        move(x_m)
        page.wait_for(lambda x=x_m: color(page, 3 - x, 0) == "r", "it is where the frame is")
        assert color(page, -x_m - 1, 0) == ""


def test_the_menu_looks_from_the_top_and_as_the_main_scene(
    viewer: webviz.Viewer, page: Page
) -> None:
    viewer.view = {"type": "Orbit", "distance": 7.5, "yaw": 0.5, "pitch": 1.0}

    def choose(name: str) -> None:
        page.tab.get_by_role("button", name="▾").click()
        page.tab.locator(".wv-menu-item", has_text=name).click()

    page.wait_for(lambda: color(page, 2, 0) == "r", "axes are there")
    choose("As the main scene")
    page.wait_for(lambda: camera_of(viewer)["distance"] == pytest.approx(7.5), "it is as near")
    assert camera_of(viewer)["pitch"] == pytest.approx(1.0)
    choose("Orbit")
    page.wait_for(lambda: camera_of(viewer)["type"] == "Orbit", "it orbits")
    choose("Top down")
    page.wait_for(lambda: camera_of(viewer)["type"] == "TopDownOrtho", "it is above")
    assert camera_of(viewer)["yaw"] == pytest.approx(-math.pi / 2)


def test_at_most_four_scenes_are_drawn(viewer: webviz.Viewer, page: Page) -> None:
    places = [{"panel": f"SceneView {n}"} for n in range(2, 6)]
    for _ in range(4):
        viewer.do(AddPanel("SceneView", {}))
    viewer.config = viewer.config | {"layout": {"below": [{"panel": "SceneView"}, *places]}}
    problem = page.tab.get_by_text("Only 4 scenes are drawn at a time")
    page.wait_for(lambda: problem.filter(visible=True).count() == 1, "one is too many")
    viewer.do(RemovePanel("3D scene"))
    page.wait_for(lambda: problem.filter(visible=True).count() == 0, "there is room for it")


def test_a_new_scene_sends_nothing_of_the_scene_again(viewer: webviz.Viewer, page: Page) -> None:
    page.wait_for(lambda: color(page, 2, 0) == "r", "axes are there")
    viewer.do(RemovePanel("3D scene"))
    page.wait_for(lambda: page.tab.locator(CANVAS).count() == 0, "it is gone")
    page.evaluate("""async () => {
      const viser = await import("webviz/viser_page.js");
      window.sceneMessages = [];
      const note = ({ type }) => window.sceneMessages.push(type);
      viser.filterMessages((all) => (all.forEach(note), all));
    }""")
    view = {"type": "TopDownOrtho", "yaw": -math.pi / 2, "distance": 12.0}
    viewer.do(AddPanel("SceneView", {"view": view}))
    page.wait_for(lambda: color(page, 2, 0) == "r", "it is there again")
    assert page.evaluate("() => window.sceneMessages") == []
