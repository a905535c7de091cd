"""Images beside the scene, in a real browser."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import lenses
import msgspec
import numpy as np
import photos
import pytest
from numpy.typing import NDArray

from webviz.api.declared import Topic
from webviz.api.nodes import Labels, Pane, Points, Pose
from webviz.api.pictures import Encoded, Mark, OverlayCamera, Packet, Pixels, Video, Warp
from webviz.api.status import Level, Status
from webviz.commands import SetLayout
from webviz.data.images import CameraModel, Lens, RawImage, Tone
from webviz.engine.state import Row
from webviz.files.config import DockedPanel, Layout, Settings
from webviz.scene import ViserScene
from webviz.server.channel.messages import MAX_PANES
from webviz.server.images.pictures import Pictures
from webviz_displays.camera import Camera
from webviz_displays.grid import Grid
from webviz_displays.image import Image

NO_ROI = SimpleNamespace(x_offset=0, y_offset=0, width=0, height=0)
COLORS, DEPTHS = photos.room(160, 120)


@pytest.fixture(scope="module")
def scene(server: Any) -> ViserScene:
    return ViserScene(server)


@pytest.fixture(scope="module")
def pictures(scene: ViserScene) -> Pictures:
    return scene.link.pictures


@pytest.fixture
def sent(scene: ViserScene, monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int]]:
    """The display and the size of each picture that is sent."""
    sent: list[tuple[str, int]] = []
    send = scene.link.channel.send_bytes

    def noting(data: bytes, key: str, browser: int) -> None:
        sent.append((key.rpartition(" ")[0], len(data)))
        send(data, key, browser)

    monkeypatch.setattr(scene.link.channel, "send_bytes", noting)
    return sent


@pytest.fixture
def tab(tab: Any, pictures: Pictures) -> Iterator[Any]:
    """The tab with two images."""
    rows = [row(name) for name in ("Color", "Depth")]
    tab.loop.show(*rows)
    pictures.show("Color", pixels(COLORS, "rgb8"))
    pictures.show("Depth", pixels(DEPTHS, "32FC1", Tone(0.5, 4.0, "Turbo")))
    tab.wait_for(lambda: shown(tab, "Color") and shown(tab, "Depth"))
    yield tab
    pictures.remove("Color")
    pictures.remove("Depth")


@pytest.fixture(scope="module")
def other(open_lasting_tab: Callable[..., Any]) -> Any:
    """Another tab, which draws the scene at the size of the page."""
    return open_lasting_tab(700, 560, resolution=1.0)


def pixels(values: NDArray[Any], encoding: str, tone: Tone | None = None, stamp: int = 1) -> Pane:
    height, width = values.shape[:2]
    data = np.frombuffer(np.ascontiguousarray(values).tobytes(), np.uint8)
    image = RawImage(width, height, encoding, len(data) // height, False, data)
    return Pane(Pixels(image, tone or Tone()), stamp * 10**9)


def row(id_: str, topic: str = "", name: str = "Image") -> Row:
    """A display of the images of a topic: its id in lower case unless given."""
    display = Image(name=name, topic=Topic(topic or f"/{id_.lower()}"))
    return Row(id_, "Image", display, name, {})


def pane(tab: Any, name: str) -> Any:
    return tab.page.get_by_label(f"Image /{name.lower()}", exact=True)


def shown(tab: Any, name: str, at: tuple[float, float] = (0.5, 0.9)) -> list[int]:
    """The colour of a place in a picture, empty as long as there is none."""
    script = """(pane, [x, y]) => {
      const canvas = pane.querySelector("canvas");
      if (!pane.dataset.stamp) return [];
      const place = [Math.floor(x * canvas.width), Math.floor(y * canvas.height), 1, 1];
      const context = canvas.getContext("2d", { willReadFrequently: true });
      return [...context.getImageData(...place).data.slice(0, 3)];
    }"""
    return pane(tab, name).evaluate(script, list(at)) if pane(tab, name).count() else []


def near(color: list[int], wanted: Any, tolerance: int = 12) -> bool:
    return len(color) == 3 and bool(np.abs(np.subtract(color, wanted)).max() <= tolerance)


def hover(tab: Any, name: str, x: float, y: float) -> str:
    box = pane(tab, name).locator(".wv-pane-picture").bounding_box()
    scale = min(box["width"] / 160, box["height"] / 120)
    left = box["x"] + (box["width"] - 160 * scale) / 2 + (x + 0.5) * scale
    top = box["y"] + (box["height"] - 120 * scale) / 2 + (y + 0.5) * scale
    tab.page.mouse.move(left, top)
    return pane(tab, name).locator(".wv-pane-value").inner_text()


def test_pictures_have_their_colors_and_hovering_reads_values(tab: Any) -> None:
    assert near(shown(tab, "Color"), COLORS[108, 80])
    assert near(shown(tab, "Depth", (0.02, 0.02)), (0, 0, 0))  # no measurement
    tab.wait_for(lambda: f"x 40 · y 100 · {DEPTHS[100, 40]:.3f} m" in hover(tab, "Depth", 40, 100))
    tab.wait_for(lambda: "no measurement" in hover(tab, "Depth", 2, 2))
    red, green, blue = COLORS[72, 96]
    tab.wait_for(lambda: f"{red} {green} {blue}" in hover(tab, "Color", 96, 72))
    assert "0.5 m" in pane(tab, "Depth").locator(".wv-pane-legend").inner_text()
    assert not pane(tab, "Color").locator(".wv-pane-legend").is_visible()


def test_only_what_is_shown_is_sent_and_only_the_newest(
    tab: Any, pictures: Pictures, sent: list[tuple[str, int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.server.images.pictures.UNSEEN_S", 0.0)
    pane(tab, "Depth").get_by_role("button", name="Collapse /depth").click()
    assert not pictures.is_unseen("Depth")
    tab.wait_for(lambda: pictures.is_unseen("Depth"))
    assert not pictures.is_unseen("Color")
    sent.clear()
    for stamp in range(2, 102):
        color = np.full_like(COLORS, stamp)
        pictures.show("Color", pixels(color, "rgb8", stamp=stamp))
        pictures.show("Depth", pixels(DEPTHS, "32FC1", stamp=stamp))
    tab.wait_for(lambda: near(shown(tab, "Color"), (101, 101, 101), 3))
    names = [name for name, _ in sent]
    assert "Depth" not in names
    assert names.count("Color") < 100
    pane(tab, "Depth").get_by_role("button", name="Expand /depth").click()
    tab.wait_for(lambda: "Depth" in [name for name, _ in sent])
    assert not pictures.is_unseen("Depth")


def test_jpeg_is_decoded_by_the_page_and_swapped_if_it_must(tab: Any, pictures: Pictures) -> None:
    data = photos.jpeg(np.full((120, 160, 3), (200, 60, 20), np.uint8))["data"]
    pictures.show("Color", Pane(Encoded("image/jpeg", data, 160, 120)))
    tab.wait_for(lambda: near(shown(tab, "Color"), (200, 60, 20)))
    tab.wait_for(lambda: "rgb 20" in hover(tab, "Color", 5, 5).replace("rgb 199", "rgb 200"))
    pictures.show("Color", Pane(Encoded("image/jpeg", data, 160, 120, True)))
    tab.wait_for(lambda: near(shown(tab, "Color"), (20, 60, 200)))
    damaged = data.copy()
    damaged[:300] = 0
    pictures.show("Color", Pane(Encoded("image/jpeg", damaged, 160, 120)))
    problem = pane(tab, "Color").locator(".wv-pane-problem")
    tab.wait_for(
        lambda: problem.is_visible() and "cannot decode this image/jpeg" in problem.inner_text()
    )
    pictures.show("Color", pixels(COLORS, "rgb8"))
    tab.wait_for(lambda: near(shown(tab, "Color"), COLORS[108, 80]) and not problem.is_visible())


def test_marks_lie_over_the_picture_and_follow_the_zoom(
    tab: Any, pictures: Pictures, sent: list[tuple[str, int]]
) -> None:
    corners = (40.0, 30.0, 80.0, 30.0, 80.0, 60.0, 40.0, 60.0)
    mark = Mark("loop", corners, "#00ff00", fill="#0000ff", width=4.0, about="Detection 7")
    plain = pixels(COLORS, "rgb8")
    marks = pane(tab, "Color").locator(".wv-pane-marks")
    pictures.show("Color", replace(plain, marks=(mark,)))
    tab.wait_for(lambda: color_of(marks, tab, 60, 45) == [0, 0, 255, 255])
    assert max(size for _, size in sent) > 500
    sent.clear()
    pictures.show("Color", replace(plain, marks=(replace_mark(mark, fill="#ff0000"),)))
    tab.wait_for(lambda: color_of(marks, tab, 60, 45) == [255, 0, 0, 255])
    assert max(size for _, size in sent) < 500, "The picture is not sent again for its marks."
    assert color_of(marks, tab, 60, 30) == [0, 255, 0, 255]
    assert color_of(marks, tab, 100, 45) == [0, 0, 0, 0]
    tab.wait_for(lambda: hover(tab, "Color", 60, 45).endswith("Detection 7"))
    tab.wait_for(lambda: "Detection" not in hover(tab, "Color", 110, 100))
    hover(tab, "Color", 60, 45)
    tab.page.mouse.wheel(0, -500)  # doubles it around the mouse
    tab.wait_for(lambda: color_of(marks, tab, 60, 22) == [255, 0, 0, 255])
    tab.page.mouse.dblclick(*middle(tab))
    pictures.show("Color", plain)
    tab.wait_for(lambda: marks.count() == 0)


def replace_mark(mark: Mark, **changes: Any) -> Mark:
    return msgspec.structs.replace(mark, **changes)


def color_of(marks: Any, tab: Any, x: float, y: float) -> list[int]:
    """RGBA of the marks where the pane shows a pixel of its picture at a zoom of 1."""
    if not marks.count():
        return []
    script = """(canvas, [x, y]) => {
      const scale = Math.min(canvas.width / 160, canvas.height / 120);
      const left = (canvas.width - 160 * scale) / 2 + x * scale;
      const top = (canvas.height - 120 * scale) / 2 + y * scale;
      return [...canvas.getContext("2d").getImageData(left, top, 1, 1).data];
    }"""
    return list(marks.evaluate(script, [x, y]))


def test_a_pane_says_what_its_display_misses_and_goes_with_it(tab: Any) -> None:
    missing = Status(Level.WARN, "No publisher on /camera. Start it.")
    rows = [
        *tab.loop.state.rows,
        msgspec.structs.replace(row("Gone"), statuses={"Topic": missing}),
    ]
    tab.loop.show(*rows)
    tab.wait_for(lambda: "No publisher on /camera" in tab.text())
    tab.loop.show(*rows[:2])
    tab.wait_for(lambda: pane(tab, "Gone").count() == 0)


def test_a_page_asks_for_as_many_pictures_as_the_server_allows(
    tab: Any, pictures: Pictures, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.server.images.pictures.UNSEEN_S", 0.0)
    names = [f"Camera{number}" for number in range(MAX_PANES + 6)]

    def seen() -> set[str]:
        return {name for name in names if not pictures.is_unseen(name)}

    tab.loop.show(*map(row, names))
    tab.wait_for(lambda: seen() == set(names[:MAX_PANES]))
    tab.loop.show(*map(row, names[10:]))
    tab.wait_for(lambda: seen() == set(names[10:]))


def test_two_images_of_one_topic_have_their_names_too(tab: Any) -> None:
    tab.loop.show(row("a", "/front", "Left"), row("b", "/front", "Right"), row("c", "/rear"))
    titles = ["/front (Left)", "/front (Right)", "/rear"]
    tab.wait_for(lambda: tab.page.locator(".wv-pane-head b").all_inner_texts() == titles)


def width(tab: Any) -> float:
    """That of the picture "Color" on the screen, in pixels."""
    canvas = pane(tab, "Color").locator("canvas")
    canvas.wait_for()
    return float(canvas.bounding_box()["width"])


def pixel_at(tab: Any, x: float, y: float) -> list[float]:
    """Column and row of the picture "Color" at a place of the window."""
    value = pane(tab, "Color").locator(".wv-pane-value")
    tab.page.mouse.move(0, 0)
    value.wait_for(state="hidden")
    tab.page.mouse.move(x, y)
    tab.wait_for(lambda: re.match(r"x \d+ . y \d+", value.inner_text()))
    words = value.inner_text().split()
    return [float(words[1]), float(words[4])]


def middle(tab: Any) -> tuple[float, float]:
    """The middle of the pane of the picture "Color" in the window."""
    box = pane(tab, "Color").locator(".wv-pane-body").bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def test_a_picture_is_zoomed_at_the_mouse_and_moved_and_the_page_is_not_zoomed(tab: Any) -> None:
    whole, (x, y) = width(tab), middle(tab)
    there = pixel_at(tab, x + 30, y + 20)
    tab.page.mouse.wheel(0, -1000)
    tab.wait_for(lambda: width(tab) == pytest.approx(4 * whole))
    assert pixel_at(tab, x + 30, y + 20) == pytest.approx(there, abs=1)
    tab.page.mouse.down()
    tab.page.mouse.move(x, y, steps=3)
    tab.page.mouse.up()
    assert pixel_at(tab, x, y) == pytest.approx(there, abs=1)
    tab.page.keyboard.down("Control")
    tab.page.mouse.wheel(0, -100)
    tab.page.keyboard.up("Control")
    tab.wait_for(lambda: width(tab) == pytest.approx(8 * whole))
    assert tab.page.evaluate("[devicePixelRatio, visualViewport.scale]") == [1, 1]
    tab.page.mouse.dblclick(x, y)
    tab.wait_for(lambda: width(tab) == pytest.approx(whole))


def test_a_picture_is_zoomed_by_keys_and_by_two_fingers(tab: Any) -> None:
    whole, (x, y) = width(tab), middle(tab)
    there = pixel_at(tab, x, y)
    pane(tab, "Color").locator("canvas").focus()
    tab.page.keyboard.press("+")
    tab.wait_for(lambda: width(tab) == pytest.approx(1.5 * whole))
    tab.page.keyboard.press("ArrowRight")
    tab.wait_for(lambda: pixel_at(tab, x, y)[0] > there[0])
    tab.page.keyboard.press("0")
    tab.wait_for(lambda: width(tab) == pytest.approx(whole))
    touch = tab.page.context.new_cdp_session(tab.page)
    touch.send("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})

    def put(event: str, *apart: float) -> None:
        points = [{"x": x + each, "y": y, "id": id_} for id_, each in enumerate(apart)]
        touch.send("Input.dispatchTouchEvent", {"type": event, "touchPoints": points})

    put("touchStart", -20, 20)
    for apart in (30, 40, 50, 60):
        put("touchMove", -apart, apart)
    put("touchEnd")
    touch.send("Emulation.setTouchEmulationEnabled", {"enabled": False})
    tab.wait_for(lambda: width(tab) == pytest.approx(3 * whole))
    assert tab.page.evaluate("visualViewport.scale") == 1
    button = tab.button("Reset the zoom of /color")
    assert "3.0" in button.inner_text()
    button.click()
    tab.wait_for(lambda: width(tab) == pytest.approx(whole))


def test_an_image_is_as_high_as_its_picture_and_is_placed_as_a_panel(tab: Any) -> None:
    body = pane(tab, "Color").locator(".wv-pane-body")
    tab.wait_for(lambda: abs((box := body.bounding_box())["width"] / box["height"] - 4 / 3) < 0.02)
    room = tab.page.locator("#root").bounding_box()
    tab.page.mouse.move(*((pane(tab, "Color").locator("b").bounding_box())[k] + 5 for k in "xy"))
    tab.page.mouse.down()
    tab.page.mouse.move(room["x"] + 100, room["y"] + room["height"] - 10, steps=4)
    tab.page.mouse.up()
    below = DockedPanel(panel="image:Image")
    tab.wait_for_command(SetLayout(Layout(below=(below,))))
    frame = tab.page.locator(".wv-below .wv-docked")
    tab.wait_for(lambda: "Hz" in frame.locator(".wv-docked-head").inner_text())
    assert frame.locator(".wv-docked-head b").inner_text() == "/color"
    assert near(shown(tab, "Color"), COLORS[108, 80])
    assert tab.page.locator(".wv-panes .wv-pane").count() == 1
    # Of two in one place, the one behind gets its pictures when it is chosen.
    both = Layout(below=(DockedPanel(panel="image:Image", tabs=("image:Image 2",)),))
    tab.loop.show(*tab.loop.state.rows, settings=Settings(layout=both))
    tab.wait_for(lambda: frame.get_by_role("tab").all_inner_texts() == ["/color", "/depth"])
    frame.get_by_role("tab", name="/depth").click()
    tab.wait_for(lambda: near(shown(tab, "Depth", (0.02, 0.02)), (0, 0, 0)))
    assert tab.page.locator(".wv-dock").is_hidden()
    frame.get_by_role("button", name="With the images").click()
    tab.wait_for_command(SetLayout(Layout(below=(below,))))
    tab.loop.show(*tab.loop.state.rows, settings=Settings())
    tab.wait_for(lambda: tab.page.locator(".wv-panes .wv-pane").count() == 2)
    assert pane(tab, "Depth").locator(".wv-pane-head").inner_text().startswith("/depth")


def test_images_and_scene_have_the_same_share_of_a_narrow_window(tab: Any) -> None:
    size = tab.page.viewport_size
    tab.page.evaluate("localStorage.clear()")
    tab.page.get_by_label("Size of the images").dblclick(position={"x": 2, "y": 300})
    root, dock = tab.page.locator("#root"), tab.page.get_by_label("Images", exact=True)
    for width, side in ((900, "width"), (700, "height")):  # beside each other, one below the other
        tab.page.set_viewport_size({"width": width, "height": 600})
        other = "height" if side == "width" else "width"

        def are_fair(side: str = side, other: str = other) -> bool:
            scene, images = root.bounding_box(), dock.bounding_box()
            like = abs(scene[other] - images[other]) < 2
            return like and abs(scene[side] - images[side]) < 50  # of the bar below

        tab.wait_for(are_fair)
    tab.page.set_viewport_size(size)


def test_panes_fill_the_window_and_leave_it(tab: Any) -> None:
    canvas = pane(tab, "Color").locator("canvas")
    before = canvas.bounding_box()["width"]
    canvas.dblclick()
    tab.wait_for(lambda: canvas.bounding_box()["width"] > 800)
    tab.page.keyboard.press("Escape")
    tab.wait_for(lambda: canvas.bounding_box()["width"] == before)
    button = pane(tab, "Color").get_by_role("button", name="Full size of /color")
    button.click()
    tab.wait_for(lambda: canvas.bounding_box()["width"] > 800)
    button.click()
    tab.wait_for(lambda: canvas.bounding_box()["width"] == before)
    border = tab.page.get_by_label("Size of the images")
    border.focus()
    tab.page.keyboard.press("ArrowLeft")
    tab.wait_for(lambda: canvas.bounding_box()["width"] > before)
    tab.page.keyboard.press("ArrowRight")
    root = tab.page.locator("#root")

    def is_beside() -> bool:
        scene, box = root.bounding_box(), canvas.bounding_box()
        return scene["width"] > 100 and scene["x"] + scene["width"] <= box["x"]

    tab.wait_for(is_beside)


def test_on_a_phone_images_are_below_the_scene(tab: Any) -> None:
    size = tab.page.viewport_size
    tab.page.set_viewport_size({"width": 400, "height": 800})
    root, canvas = tab.page.locator("#root"), pane(tab, "Color").locator("canvas")

    def is_below() -> bool:
        scene, box = root.bounding_box(), canvas.bounding_box()
        return scene["width"] == 400 and box["y"] >= scene["y"] + scene["height"] > 100

    tab.wait_for(is_below)
    tab.button("Show the panels").click()
    tab.page.get_by_role("button", name="Add display").click(trial=True)  # nothing is above it
    tab.button("Hide the panels").click()
    tab.page.set_viewport_size(size)
    tab.wait_for(lambda: root.bounding_box()["width"] < size["width"] - 600)


def test_the_scene_is_over_the_image_where_the_camera_sees_it(
    scene: ViserScene, pictures: Pictures, other: Any
) -> None:
    # Points along rays of the rectified camera, and the pixels in which OpenCV sees them.
    chosen = {"red": (2, (255, 0, 0)), "green": (3, (0, 255, 0)), "blue": (1, (0, 0, 255))}
    _, _, seen = lenses.SEEN["plumb_bob"]
    image = np.zeros((lenses.HEIGHT, lenses.WIDTH, 3), np.uint8)
    for name, (index, color) in chosen.items():
        xyz = np.array([2.0 * lenses.RAYS[index]], np.float32)
        group = f"{name.title()}/draw"
        scene.set_pose(group, Pose((5.0, 6.0, 7.0)))
        scene.upsert(group, "dot", Points(xyz, color, 0.06))
        column, row = map(round, seen[index])
        image[row - 7 : row + 8, column - 7 : column + 8] = color
    middle = np.array([(0.0, 0.0, 2.0)], np.float32)
    scene.upsert("Red/draw", "text", Labels(middle, ("Text",), 0.3))
    scene.flush()
    info = SimpleNamespace(**lenses.info("plumb_bob"), roi=NO_ROI)
    camera = CameraModel.whole(info)
    grid = Lens.of(info).grid(camera)
    assert grid is not None
    overlay_camera = OverlayCamera(
        position=(5.0, 6.0, 7.0),
        wxyz=(1.0, 0.0, 0.0, 0.0),
        size=(camera.width, camera.height),
        focal=(camera.fx, camera.fy),
        principal=(camera.cx, camera.cy),
        part=(0.0, 0.0, 1.0, 1.0),
        far=100.0,
        zoom=0.75,
        overlay=0.0,
        is_background=False,
        warp=Warp(grid),
    )

    def dots() -> dict[str, Any]:
        """Return where each colour is in the pane: column, row, and number of pixels."""
        return other.page.get_by_label("Image /camera/image_raw", exact=True).evaluate(FIND)

    def expected(index: int) -> Any:
        """The place of a ray by hand: the pane shows 4/3 of the camera's width."""
        width, height = dots()["size"]
        pixel = np.array((camera.cx, camera.cy)) + 580.0 * lenses.RAYS[index][:2] + 0.5
        scale = 0.75 * min(width / 640, height / 480)
        return np.array((width, height)) / 2 + (pixel - (320, 240)) * scale

    def are_right(names: set[str], has_text: bool = False) -> bool:
        result = dots()
        if {name for name in chosen if result[name]} != names:
            return False
        if result["white"] != has_text:
            return False
        return all(
            np.abs(np.subtract(result[name][:2], expected(chosen[name][0]))).max() < 2.0
            for name in names
        )

    rows = [Row(name.title(), "Grid", Grid(name=name.title()), name.title(), {}) for name in chosen]
    other.loop.show(Row("Camera", "Camera", Camera(name="Camera"), "Camera", {}), *rows)
    try:
        pictures.show("Camera", replace(pixels(image, "rgb8"), camera=overlay_camera))
        other.wait_for(lambda: are_right({"red", "green", "blue"}, has_text=True))  # of the scene
        hiding = Camera(name="Camera", visibility={"Red": False})
        other.loop.show(Row("Camera", "Camera", hiding, "Camera", {}), *rows)
        other.wait_for(lambda: are_right({"green", "blue"}))
        for name in chosen:
            scene.remove_group(f"{name.title()}/draw")
        scene.flush()
        other.wait_for(lambda: are_right(set()))
        # Of the image alone, undistorted: it fits the scene.
        pictures.show(
            "Camera", replace(pixels(image, "rgb8"), camera=replace(overlay_camera, overlay=1.0))
        )
        other.wait_for(lambda: are_right({"red", "green", "blue"}))
        result = dots()
        x, y = (result["blue"][i] / result["size"][i] for i in range(2))
        canvas = other.page.get_by_label("Image /camera/image_raw", exact=True).locator("canvas")
        box = canvas.bounding_box()
        column, row = map(round, seen[1])
        value = other.page.get_by_label("Image /camera/image_raw", exact=True).locator(
            ".wv-pane-value"
        )

        def reads() -> bool:
            other.page.mouse.move(box["x"] + x * box["width"], box["y"] + y * box["height"])
            words = value.inner_text().split()
            if len(words) < 8 or words[-3:] != ["0", "0", "255"]:
                return False
            return abs(int(words[1]) - column) <= 3 and abs(int(words[4]) - row) <= 3

        other.wait_for(reads)
    finally:
        pictures.remove("Camera")


FIND = """(pane) => {
  const canvas = pane.querySelector("canvas");
  const { width, height } = canvas;
  const found = { size: [width, height], red: null, green: null, blue: null, white: false };
  if (!pane.dataset.stamp) return found;
  const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
  for (const [channel, name] of ["red", "green", "blue"].entries()) {
    let [x, y, count] = [0, 0, 0];
    for (let i = 0; i < data.length; i += 4) {
      const [own, ...others] = [0, 1, 2].map((k) => data[i + ((channel + k) % 3)]);
      if (own < 150 || Math.max(...others) > 60) continue;
      x += ((i / 4) % width) + 0.5;
      y += Math.floor(i / 4 / width) + 0.5;
      count += 1;
    }
    if (count) found[name] = [x / count, y / count, count];
  }
  for (let i = 0; i < data.length; i += 4) found.white ||= Math.min(...data.slice(i, i + 3)) > 200;
  return found;
}"""


RECORD = """async (codec) => {
  const supported = await VideoEncoder.isConfigSupported({codec, width: 160, height: 120});
  if (!supported.supported) return null;
  const packets = [];
  const encoder = new VideoEncoder({
    output: (chunk) => {
      const data = new Uint8Array(chunk.byteLength);
      chunk.copyTo(data);
      packets.push([...data]);
    },
    error: () => {},
  });
  encoder.configure({codec, width: 160, height: 120, latencyMode: "realtime"});
  const canvas = new OffscreenCanvas(160, 120);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  for (let i = 0; i < 5; i++) {
    context.fillStyle = `rgb(${40 * (i + 1)} 40 40)`;
    context.fillRect(0, 0, 160, 120);
    const frame = new VideoFrame(canvas, {timestamp: i * 33000});
    encoder.encode(frame, {keyFrame: i === 0});
    frame.close();
  }
  await encoder.flush();
  return packets;
}"""


def test_video_is_decoded_by_the_page(tab: Any, pictures: Pictures) -> None:
    recorded = tab.page.evaluate(RECORD, "vp09.00.10.08")
    assert recorded is not None
    packets = tuple(
        Packet(number, np.array(data, np.uint8)) for number, data in enumerate(recorded)
    )
    pictures.show("Color", Pane(Video("vp9", packets[:2])))
    tab.wait_for(lambda: near(shown(tab, "Color"), (80, 40, 40), 25))
    pictures.show("Color", Pane(Video("vp9", packets)))
    tab.wait_for(lambda: near(shown(tab, "Color"), (200, 40, 40), 25))
    pictures.show("Color", Pane(Video("h264", (Packet(9, np.zeros(50, np.uint8)),))))
    problem = pane(tab, "Color").locator(".wv-pane-problem")

    def again() -> bool:
        pictures.show("Color", Pane(Video("h264", (Packet(10, np.zeros(50, np.uint8)),))))
        return problem.is_visible()

    tab.wait_for(again)
    pictures.show("Color", Pane(Video("vp9", packets)))
    tab.wait_for(lambda: near(shown(tab, "Color"), (200, 40, 40), 25) and not problem.is_visible())


def test_a_picture_that_is_decoded_later_is_not_drawn_over_a_newer_one(
    tab: Any, pictures: Pictures
) -> None:
    tab.page.evaluate("""() => {
      const decode = window.createImageBitmap;
      window.createImageBitmap = async (...image) => {
        window.createImageBitmap = decode;  // the next is not delayed
        window.isDecoding = true;
        await new Promise((resolve) => { window.decodeIt = resolve; });
        requestAnimationFrame(() => requestAnimationFrame(() => { window.isLate = true; }));
        return decode(...image);
      };
    }""")
    pictures.show("Color", pixels(np.full_like(COLORS, 200), "rgb8"))
    tab.wait_for(lambda: tab.page.evaluate("window.isDecoding"))
    pictures.show("Color", pixels(np.full_like(COLORS, 100), "rgb8"))
    tab.turn()
    tab.page.evaluate("window.decodeIt()")
    tab.wait_for(lambda: near(shown(tab, "Color"), (100, 100, 100), 3))
    tab.page.wait_for_function("window.isLate")
    assert near(shown(tab, "Color"), (100, 100, 100), 3)


def test_two_pages_and_a_flood_leave_no_queue(
    tab: Any, pictures: Pictures, sent: list[tuple[str, int]], other: Any
) -> None:
    other.wait_for(lambda: shown(other, "Color") and shown(other, "Depth"))
    flood = threading.Thread(target=_flood, args=(pictures,))
    flood.start()
    tab.wait_for(lambda: not flood.is_alive())
    for each in (tab, other):
        each.wait_for(lambda each=each: near(shown(each, "Color"), (7, 7, 7), 3))
    assert len(sent) < FLOOD, "A page is sent the next one once it has shown one before."


FLOOD = 2000
"""Pictures, for two pages each."""


def _flood(pictures: Pictures) -> None:
    for _ in range(FLOOD):
        pictures.show("Color", pixels(COLORS, "rgb8"))
        time.sleep(0.0002)
    pictures.show("Color", pixels(np.full_like(COLORS, 7), "rgb8"))
