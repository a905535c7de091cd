"""Views in a real browser: what is where in the picture, and what the mouse does."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image
import playwright.sync_api as playwright
import pytest
from numpy.typing import NDArray
from pages import let_keys_in, let_mouse_in
from viser_internals import cut_connections

from tests.scene import conftest
from webviz.api.nodes import Instances, Labels, Lines, Pose
from webviz.api.views import (
    FIELD_OF_VIEW,
    FPS,
    Orbit,
    ThirdPersonFollower,
    TopDownOrtho,
    View,
    XYOrbit,
    target_group,
)
from webviz.scene import ViserScene, open_server
from webviz.shell.pictures.browser import Page

WIDTH, HEIGHT = 480, 320
"""Size of a page so narrow that the panels are folded away."""
MIDDLE = X, Y = WIDTH / 2, HEIGHT / 2
HANDLE = (150, 190)
"""The pixel at which drags begin."""
RED, WHITE = (255, 0, 0), (255, 255, 255)
HALF = math.tan(FIELD_OF_VIEW / 2)
AXES = """async () => {
  const { axes } = await import("webviz/scene/view.js");
  return axes().flat();
}"""


class Window(Page):
    """One browser tab, which draws only when it is looked at."""

    def __init__(self, browser: playwright.Browser, scene: ViserScene) -> None:
        self.scene = scene
        self.server = scene.link.server
        self.clicks: list[Any] = []
        url = f"http://127.0.0.1:{self.server.get_port()}"
        super().__init__(browser, url, WIDTH, HEIGHT)
        self.wait_for(scene.cameras.views, "the page has reported its view")
        self.hold()
        let_mouse_in(self)
        self.server.scene.on_click()(self.clicks.append)

    @property
    def view(self) -> View:
        """Return the view the server believes is shown."""
        (view,) = self.scene.cameras.views().values()
        return view

    @property
    def size(self) -> tuple[float, float]:
        """Return the size of the picture, as the server has it."""
        (browser,) = self.scene.cameras.views()
        return self.scene.cameras.size(browser)

    def look(self, view: View) -> None:
        """Show a view, and wait until the page has reported it."""
        self.scene.cameras.show(view)
        # Until then the server believes what it asked for, and then what the page has.
        self.wait_for(lambda: self.view is not view, "the report of the page")
        self.settle_down()

    def settle_down(self) -> None:
        """Wait until all that was flushed is drawn."""
        self.scene.flush()
        self.wait_for(lambda: self.scene.acknowledge(30) or True, "it has all")
        self.draw(4)

    def tell(self, change: Any, what: str) -> View:
        """Wait until the view the server believes in fulfils a condition, and return it."""
        self.wait_for(lambda: change(self.view), what)
        return self.view

    def is_red(self) -> NDArray[np.bool_]:
        """Return the mask of red pixels."""
        pixels = self.pixels().astype(int)
        return (pixels[..., 0] > 90) & (pixels[..., 1] < 60) & (pixels[..., 2] < 60)

    def red(self) -> tuple[float, float, float, float]:
        """Left, top, right and bottom edge of all that is red."""
        rows, columns = np.nonzero(self.is_red())
        return columns.min(), rows.min(), columns.max() + 1, rows.max() + 1

    def drag(self, dx: int, dy: int, button: Any = "left", shift: bool = False) -> None:
        """Drag the mouse from `HANDLE`."""
        mouse, keyboard = self.tab.mouse, self.tab.keyboard
        x, y = HANDLE
        mouse.move(x, y)
        if shift:
            keyboard.down("Shift")
        mouse.down(button=button)
        mouse.move(x + dx / 2, y + dy / 2)
        mouse.move(x + dx, y + dy)
        mouse.up(button=button)
        if shift:
            keyboard.up("Shift")


@pytest.fixture(scope="module")
def lasting_window(browser: playwright.Browser) -> Iterator[Window]:
    server = open_server(port=0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(browser, "new_context", partial(browser.new_context, every_frame=True))  # pyright: ignore[reportCallIssue]
        window = Window(browser, ViserScene(server))
    yield window
    window.close()
    server.stop()


@pytest.fixture
def window(lasting_window: Window) -> Iterator[Window]:
    """A tab with an empty scene."""
    lasting_window.scene.clear()
    lasting_window.clicks.clear()
    yield lasting_window
    assert lasting_window.errors == []


def box(x: float, y: float, z: float, *size: float) -> Instances:
    """A red box with its middle there."""
    return Instances(np.array([(x, y, z)], np.float32), np.array([size], np.float32), RED)


ANYTHING = [
    Orbit(distance=6.0, yaw=-2.0, pitch=0.4, focal_point=(1.0, 2.0, -0.5)),
    XYOrbit(distance=6.0, yaw=0.4, pitch=0.9, focal_point=(1.0, 2.0, 0.0)),
    ThirdPersonFollower(distance=6.0, yaw=3.0, pitch=0.2, focal_point=(1.0, 2.0, 0.0)),
    FPS(yaw=2.5, pitch=-0.3, position=(1.0, -2.0, 1.5)),
    TopDownOrtho(scale=37.5, angle=2.0, x=-3.0, y=1.25),
]


@pytest.mark.parametrize("view", ANYTHING, ids=lambda view: type(view).__name__)
def test_a_browser_reports_the_view_that_it_was_given(window: Window, view: View) -> None:
    window.look(view)
    assert window.view == view


def test_points_are_where_a_view_with_perspective_has_them(window: Window) -> None:
    # From the south at the height of the focal point: x is to the right, z is up.
    window.look(Orbit(distance=10.0, yaw=-math.pi / 2, pitch=0.0, focal_point=(1.0, 0.0, 2.0)))
    px = HEIGHT / 2 / HALF / 10.0
    assert window.pixel_of(2.0, 0.0, 3.0) == pytest.approx((X + px, Y - px), abs=0.01)
    # The same from where the camera is, which looks along y.
    window.look(FPS(position=(1.0, -10.0, 2.0), yaw=math.pi / 2))
    assert window.pixel_of(2.0, 0.0, 3.0) == pytest.approx((X + px, Y - px), abs=0.02)
    # RViz raises the camera of XYOrbit by a fifth of the distance.
    window.look(XYOrbit(distance=10.0, yaw=-math.pi / 2, pitch=0.0, focal_point=(1.0, 0.0, 0.0)))
    assert window.pixel_of(1.0, 0.0, 0.0) == pytest.approx((X, Y + 2 * px), abs=0.01)


def test_from_above_a_meter_has_as_many_pixels_at_every_height(window: Window) -> None:
    window.scene.upsert("tower", "t", box(1.0, 0.5, 4.0, 2.0, 1.0, 8.0))
    window.look(TopDownOrtho(scale=40.0))
    assert window.red() == (X, Y - 40, X + 80, Y)
    for z in (-20.0, 0.0, 50.0):
        assert window.pixel_of(3.0, 2.0, z) == pytest.approx((X + 120, Y - 80), abs=0.05)


def test_parallel_lines_stay_parallel_from_above(window: Window) -> None:
    sloped = [[(x, -3.0, 0.0), (x + 1.0, 3.0, 10.0)] for x in (-4.0, 0.0, 4.0)]
    window.scene.upsert("lines", "l", Lines(np.array(sloped, np.float32), RED, 2.0))
    window.look(TopDownOrtho(scale=40.0, angle=0.3, x=0.5))
    slopes = []
    for start, end in sloped:
        (x0, y0), (x1, y1) = window.pixel_of(*start), window.pixel_of(*end)
        slopes.append(math.atan2(y1 - y0, x1 - x0))
        middle = window.is_red()[int((y0 + y1) / 2) - 2 :, int((x0 + x1) / 2) - 2 :][:5, :5]
        assert middle.any()  # the line is drawn where its ends say
    assert slopes == pytest.approx([slopes[0]] * 3, abs=1e-4)


def test_up_from_above_is_turned_by_the_angle_as_rviz_does(window: Window) -> None:
    window.look(TopDownOrtho(scale=40.0, angle=math.pi / 2))
    column, row = window.pixel_of(-1.0, 0.0, 0.0)  # up is (-sin, cos) of the angle
    assert (column, row) == pytest.approx((X, Y - 40), abs=0.05)


def test_scale_is_kept_when_the_page_gets_another_size(window: Window) -> None:
    window.look(TopDownOrtho(scale=40.0, x=1.0))
    window.resize_picture(WIDTH, 200)
    view = window.tell(
        lambda _: window.scene.cameras.size(max(window.scene.cameras.views()))[1] == 200, "size"
    )
    assert view == TopDownOrtho(scale=40.0, x=1.0)
    window.draw(4)
    assert window.pixel_of(2.0, 1.0) == pytest.approx((X + 40, 100 - 40), abs=0.05)
    window.resize_picture(WIDTH, HEIGHT)
    window.wait_for(lambda: window.size == (WIDTH, HEIGHT), "the size")


PICKED = [
    TopDownOrtho(scale=50.0, angle=0.4),
    TopDownOrtho(scale=50.0, angle=-1.0, x=1.0, target_frame="base"),
    Orbit(distance=12.0, yaw=-1.9, pitch=0.8, target_frame="base"),
]


@pytest.mark.parametrize("view", PICKED, ids=["above", "above and following", "orbit"])
def test_a_click_is_right_to_two_pixels(window: Window, view: View) -> None:
    window.scene.set_pose(target_group("base"), Pose((1.0, -0.5, 0.0)))
    window.look(view)
    for point in ((-1.0, -0.8), (0.3, 0.2)):
        column, row = window.pixel_of(*point)
        window.clicks.clear()
        window.tab.mouse.click(column, row)
        window.wait_for(lambda: window.clicks, "the click arrives")
        (click,) = window.clicks
        origin, direction = np.array(click.ray_origin), np.array(click.ray_direction)
        hit = origin - direction * origin[2] / direction[2]
        assert math.dist(window.pixel_of(*hit.tolist()), (column, row)) < 2.0


def robot_at(window: Window, x: float, y: float, yaw: float = 0.0) -> None:
    pose = Pose((x, y, 0.0), (math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)))
    for group in ("robot", target_group("base")):
        window.scene.set_pose(group, pose)


FOLLOWING = [
    (Orbit(distance=6.0, target_frame="base"), 0.0),
    (XYOrbit(distance=6.0, target_frame="base"), 0.0),
    (FPS(position=(-4.0, 0.0, 1.0), target_frame="base"), 0.0),
    (TopDownOrtho(scale=80.0, target_frame="base"), 0.0),
    (ThirdPersonFollower(distance=6.0, target_frame="base"), 1.1),
]


@pytest.mark.parametrize(("view", "yaw"), FOLLOWING, ids=lambda case: type(case).__name__)
def test_a_followed_robot_stands_still_while_the_world_moves(
    window: Window, view: View, yaw: float
) -> None:
    window.scene.upsert("robot", "r", box(0.0, 0.0, 0.3, 1.0, 0.6, 0.6))
    window.scene.upsert("world", "w", Lines(np.array([[(0, -1, 0), (0, 1, 0)]], np.float32), WHITE))
    robot_at(window, 0.0, 0.0)
    window.look(view)
    edges, world = window.red(), window.pixel_of(0.0, 0.0)
    robot_at(window, 1.3, -0.7, yaw)
    window.settle_down()
    assert window.red() == pytest.approx(edges, abs=1)
    assert math.dist(window.pixel_of(0.0, 0.0), world) > 50
    assert window.view == view  # relative to the robot nothing has changed


def test_robot_label_and_camera_move_in_the_same_picture(window: Window) -> None:
    window.scene.upsert("robot", "r", box(0.0, 0.0, 0.3, 1.0, 0.6, 0.6))
    window.scene.upsert("robot", "l", Labels(np.array([(0, 0, 1)], np.float32), ("base",), 0.3))
    robot_at(window, 0.0, 0.0)
    window.look(Orbit(distance=6.0, target_frame="base"))
    window.evaluate(
        """() => {
          const {canvas, requestRender} = window.__viserMutable;
          const copy = document.createElement("canvas");
          copy.width = canvas.width; copy.height = canvas.height;
          const image = copy.getContext("2d", {willReadFrequently: true});
          window.middles = [];
          window.watching = true;
          (function watch() {
            if (!window.watching) return;
            image.drawImage(canvas, 0, 0);
            const {data} = image.getImageData(0, 0, canvas.width, canvas.height);
            const sums = [[0, 0], [0, 0]];  // of the robot, and of the label
            for (let i = 0; i < data.length; i += 4) {
              const [r, g] = [data[i], data[i + 1]];
              const sum = r > 90 && g < 60 ? sums[0] : r > 200 && g > 200 ? sums[1] : null;
              if (sum) { sum[0] += 1; sum[1] += (i / 4) % canvas.width; }
            }
            window.middles.push(sums.map(([count, sum]) => sum / count));
            requestRender();
            requestAnimationFrame(watch);
          })();
        }"""
    )
    steps = itertools.count(1)

    def goes_on() -> bool:
        step = next(steps)
        robot_at(window, 0.05 * step, 0.02 * step)
        window.scene.flush()
        return window.evaluate("() => window.middles.length") > 10

    window.wait_for(goes_on, "eleven pictures on the way", 60)
    middles = np.array(window.evaluate("() => { window.watching = false; return window.middles; }"))
    assert np.ptp(middles, axis=0) == pytest.approx((0.0, 0.0), abs=0.5)


def test_a_view_whose_frame_is_not_there_stays_where_it_was(window: Window) -> None:
    window.look(Orbit(distance=6.0, focal_point=(1.0, 0.0, 0.0)))
    place = window.pixel_of(0.0, 0.0)
    window.look(Orbit(distance=6.0, focal_point=(1.0, 0.0, 0.0), target_frame="nowhere"))
    assert window.pixel_of(0.0, 0.0) == pytest.approx(place, abs=0.01)


# The mouse


def test_the_mouse_turns_moves_and_zooms_a_view_from_above(window: Window) -> None:
    window.look(TopDownOrtho(scale=50.0))
    window.drag(100, 0)
    window.tell(lambda view: abs(view.angle + 0.5) < 1e-3, "RViz turns by 5 mrad/px")
    window.look(TopDownOrtho(scale=50.0))
    window.drag(100, 50, "middle")
    window.tell(lambda view: math.dist((view.x, view.y), (-2.0, 1.0)) < 1e-3, "100 px are 2 m")
    window.drag(-100, -50, shift=True)
    window.tell(lambda view: math.hypot(view.x, view.y) < 1e-3, "moved back")
    window.tab.mouse.wheel(0, -120)
    window.tell(lambda view: abs(view.scale - 50.0 / 0.88) < 0.1, "zoomed in")


@pytest.mark.parametrize("view", [Orbit(distance=10.0), XYOrbit(distance=10.0)], ids=type)
def test_the_camera_comes_and_goes_as_far_as_in_rviz(window: Window, view: View) -> None:
    window.look(view)
    window.tab.mouse.move(*HANDLE)
    window.tab.mouse.wheel(0, 120)
    window.tell(lambda view: abs(view.distance - 11.2) < 1e-3, "a notch goes away by 12 %")
    window.look(view)
    window.tab.mouse.wheel(0, -120)
    window.tell(lambda view: abs(view.distance - 8.8) < 1e-3, "a notch comes closer by 12 %")
    window.look(view)
    window.drag(0, 10, "right")
    window.tell(lambda view: abs(view.distance - 10 * 1.01**10) < 1e-3, "down goes away, 1 %/px")


def test_moving_orbit_stays_in_the_plane_of_the_picture(window: Window) -> None:
    window.look(Orbit(distance=10.0, yaw=0.0, pitch=math.pi / 6))
    window.drag(0, 50, "middle")

    def has_moved_in_plane(view: Orbit) -> bool:
        x, y, z = view.focal_point
        return abs(x) > 0.05 and (z / x, y) == pytest.approx((-math.sqrt(3.0), 0.0), abs=1e-3)

    window.tell(has_moved_in_plane, "it moved, and at rest it is in the plane")  # on the way nearly


def test_the_mouse_looks_around_and_walks_in_fps(window: Window) -> None:
    window.look(FPS(position=(0.0, 0.0, 2.0)))
    window.drag(100, 40)
    what = "5 mrad/px to the right and down"
    view = window.tell(lambda view: math.dist((view.yaw, view.pitch), (-0.5, 0.2)) < 1e-3, what)
    assert isinstance(view, FPS)
    assert math.dist(view.position, (0.0, 0.0, 2.0)) < 0.01
    window.look(FPS(position=(0.0, 0.0, 2.0)))
    window.drag(0, -20, "right")
    window.tell(lambda view: math.dist(view.position, (2.0, 0.0, 2.0)) < 1e-2, "walked 2 m")
    window.drag(100, 0, "middle")
    window.tell(lambda view: math.dist(view.position, (2.0, 1.0, 2.0)) < 1e-2, "1 m sideways")


def test_turning_and_zooming_xy_orbit_keep_its_focal_point(window: Window) -> None:
    window.look(XYOrbit(distance=10.0, pitch=0.8, focal_point=(1.0, 2.0, 0.0)))
    window.drag(80, 60)
    window.tab.mouse.wheel(0, -120)
    what = "it turned and came closer"
    view = window.tell(lambda v: abs(v.distance - 8.8) + abs(v.pitch - 1.1) < 1e-2, what)
    window.tell(lambda v: math.dist(v.focal_point, (1.0, 2.0, 0.0)) < 1e-2, f"{what}: {view}")


def test_moving_xy_orbit_keeps_the_point_of_the_ground_under_the_mouse(window: Window) -> None:
    window.look(XYOrbit(distance=10.0, yaw=0.3, pitch=0.6, focal_point=(1.0, 0.5, 0.0)))
    under = "async (xy) => (await import('webviz/scene/ground.js')).groundAt(...xy)"
    before = window.evaluate(under, HANDLE)
    window.drag(30, 20, "middle")
    window.tell(lambda view: math.dist(view.focal_point, (1.0, 0.5, 0.0)) > 0.3, "it moved")
    now, point = [HANDLE[0] + 30, HANDLE[1] + 20], pytest.approx(before, abs=1e-2)
    window.wait_for(lambda: window.evaluate(under, now) == point, "it is under the mouse again")
    window.tell(lambda view: abs(view.focal_point[2]) < 1e-5, "on the ground")


@pytest.mark.parametrize(
    "view",
    [
        Orbit(distance=8.0, yaw=-1.6),
        TopDownOrtho(scale=50.0),
        FPS(position=(0.0, -6.0, 3.0), yaw=1.6, pitch=0.4),
    ],
    ids=lambda view: type(view).__name__,
)
def test_f_focuses_the_point_under_the_mouse(window: Window, view: View) -> None:
    window.scene.upsert("box", "b", box(-1.5, -0.5, 0.5, 1.0, 1.0, 1.0))
    window.look(view)
    left, top, right, bottom = window.red()
    column, row = (left + right) / 2, (top + bottom) / 2
    window.tab.mouse.move(column, row)
    point = window.evaluate(
        """(mouse) => {
          const world = window.__viserMutable.nodeRefFromName["/webviz"].matrixWorld;
          return window.webviz.pick(mouse).applyMatrix4(world.clone().invert()).toArray();
        }""",
        [column, row],
    )
    assert -2.0 <= point[0] <= -1.0
    assert point[2] > 0.01  # the box, not the ground below it
    let_keys_in(window)
    window.tab.keyboard.press("f")
    window.wait_for(lambda: math.dist(window.pixel_of(*point), MIDDLE) < 2.0, "in the middle")


# Pictures


def test_a_screenshot_of_the_view_is_downloaded(view: conftest.View, tmp_path: Path) -> None:
    """The page draws all the time."""
    view.scene.upsert("box", "b", box(0.0, 0.0, 0.5, 1.0, 1.0, 1.0))
    view.show()
    for name in ("robot.png", ""):
        with view.tab.expect_download() as download:
            view.scene.cameras.save_image(name)
        file = download.value
        file.save_as(tmp_path / "saved.png")
        picture = np.asarray(PIL.Image.open(tmp_path / "saved.png").convert("RGB"))
        np.testing.assert_array_equal(picture, view.pixels())
        if name:
            assert file.suggested_filename == name
        else:
            stamp = datetime.strptime(file.suggested_filename, "webviz %Y-%m-%d %H.%M.%S.png")
            assert abs((datetime.now() - stamp).total_seconds()) < 60


def test_a_page_that_lost_its_connection_keeps_its_view(window: Window) -> None:
    view = TopDownOrtho(scale=33.0, x=2.0)
    window.look(view)
    before, axes = set(window.server.get_clients()), window.evaluate(AXES)
    cut_connections(window.server)
    window.wait_for(lambda: set(window.server.get_clients()) - before, "it is back")
    window.wait_for(
        lambda: list(window.scene.cameras.views().values()) == [view], "its view was reported"
    )
    window.draw()
    assert window.evaluate(AXES) == pytest.approx(axes)
