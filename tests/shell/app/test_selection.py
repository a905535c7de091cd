"""Selecting in a real browser: what is clicked on is what is answered, exactly."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import playwright.sync_api as playwright
import pytest
from clouds import xyz_cloud
from numpy.typing import NDArray
from pages import bounds, open_pages
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

import webviz
from webviz.commands import RemoveDisplay, SetFixedFrame, SetProperty, ShowView
from webviz.data.messages import decode, encode
from webviz.files.opening import parse
from webviz.shell.app.picture_controls import checked_view
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import HandFedSource

SHARED = Path(__file__).parents[4] / "shared/data"
PCD = SHARED / "clouds/251370668.pcd"
BAG = SHARED / "bags/macfirst_floor_take_2"
MARKERS = "visualization_msgs/msg/MarkerArray"
COUNT = 90_000
"""Points of a cloud; a tenth cannot be drawn, and of the others 75 000 are: more than two bytes
count."""
CONFIG = """
fixed_frame: map
background: [0, 0, 0]
displays:
- {type: PointCloud2, name: Cloud, topic: /cloud, size: 0.15, max_points: 75000}
- {type: Grid}
- {type: LaserScan, name: Scan, topic: /scan, size: 0.02, enabled: false}
- {type: MarkerArray, name: Markers, topic: /markers, enabled: false}
"""
MARKED = """() => {
  const canvas = document.querySelector(".wv-highlight");
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return data.some((byte) => byte > 0);
}"""
SIZE = 1100, 700
"""Size of the window in pixels."""
TITLE = ".wv-selection [data-thing] .wv-field-name"


@pytest.fixture(scope="module")
def source() -> HandFedSource:
    return HandFedSource()


@pytest.fixture(scope="module")
def viewer(source: HandFedSource) -> Iterator[webviz.Viewer]:
    with webviz.Viewer(port=0, source=source, read=lambda *_: parse(CONFIG, "x.yaml")) as viewer:
        yield viewer


@pytest.fixture(scope="module")
def page(browser: playwright.Browser, viewer: webviz.Viewer) -> Iterator[Page]:
    with open_pages(browser, viewer.url, *SIZE, count=1, resolution=1.0) as (page,):
        yield page


def random_places() -> NDArray[np.float64]:
    """Return places in a square of 40 m, at all heights."""
    return np.random.default_rng(0).uniform((-20, -20, 0), (20, 20, 5), (COUNT, 3))


def street() -> NDArray[np.float64]:
    """A real cloud, as often as it takes, each time a little elsewhere."""
    head, _, data = PCD.read_bytes().partition(b"DATA binary\n")
    names = next(line.split()[1:] for line in head.splitlines() if line.startswith(b"FIELDS"))
    xyz = np.frombuffer(data, "<f4").reshape(-1, len(names))[:, :3].astype(np.float64)
    times = -(-COUNT // len(xyz))
    shifts = np.random.default_rng(1).uniform(-0.5, 0.5, (times, 1, 3))
    return (xyz + shifts).reshape(-1, 3)[:COUNT]


def numbered_cloud(xyz: NDArray[np.float64]) -> dict[str, Any]:
    """A cloud whose points have the colour that is their index; every tenth is not finite."""
    points = np.zeros(COUNT, [("xyz", "<f4", 3), ("rgb", "<u4"), ("temperature", "<f8")])
    points["xyz"] = xyz
    points["xyz"][::10, 0] = np.nan
    points["rgb"] = np.arange(1, COUNT + 1)
    points["temperature"] = 0.1 * np.arange(COUNT)
    places = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("rgb", 12, 6), ("temperature", 16, 8)]
    keys = ("name", "offset", "datatype")
    return {
        "height": 1,
        "width": COUNT,
        "fields": [{**dict(zip(keys, place, strict=True)), "count": 1} for place in places],
        "point_step": 24,
        "row_step": 24 * COUNT,
        "data": points.view(np.uint8),
    }


def pixels(page: Page) -> NDArray[np.uint8]:
    """The scene at its place in the window."""
    box = bounds(page.tab.locator("canvas").first)
    scene, window = page.pixels(), np.zeros((*reversed(SIZE), 3), np.uint8)
    left, top = round(box["x"]), round(box["y"])
    window[top : top + len(scene), left : left + scene.shape[1]] = scene
    return window


MIDDLE = np.s_[120:600, 400:900]
"""Area of the page away from its panels."""


def pixels_at_rest(page: Page) -> NDArray[np.uint8]:
    """A picture that the next one equals: on a busy machine the view is on its way for a while."""
    pictures = [pixels(page)]

    def rests() -> bool:
        page.draw()
        pictures.append(pixels(page))
        return np.array_equal(pictures[-2][MIDDLE], pictures[-1][MIDDLE])

    page.wait_for(rests, "the picture rests")
    return pictures[-1]


def numbers_in(picture: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Index of the point that each pixel shows, -1 where there is none."""
    return picture.astype(np.int64) @ (65536, 256, 1) - 1


def publish(source: HandFedSource, topic: str, type_name: str, values: dict[str, Any]) -> None:
    source.now += 1_000_000_000
    values = {**values, "header": header("map", source.now)}
    source.put(topic, type_name, encode(type_name, values))


def test_a_click_on_a_point_of_75_000_gets_its_index_in_the_message(
    viewer: webviz.Viewer, source: HandFedSource, page: Page
) -> None:
    """Pixels show the index of their point as a colour; edges are smooth, so others are used."""
    places = street() if PCD.exists() else random_places()
    publish(source, "/cloud", "sensor_msgs/msg/PointCloud2", numbered_cloud(places))
    view = {"type": "Orbit", "distance": 30.0, "pitch": 0.9, "yaw": 0.7}
    viewer.do(ShowView(checked_view(view)))
    page.draw()
    numbers = numbers_in(pixels_at_rest(page))
    around = [np.roll(numbers, shift, (0, 1)) for shift in itertools.product((-1, 0, 1), repeat=2)]
    is_one = (np.stack(around) == numbers).all(axis=0) & (numbers >= 0) & (numbers < COUNT)
    ys, xs = np.nonzero(is_one[MIDDLE])
    page.tab.keyboard.press("Escape")
    page.tab.keyboard.press("s")
    for row in np.random.default_rng(2).choice(len(xs), 2, replace=False):
        x, y = int(xs[row]) + 400, int(ys[row]) + 120
        index = int(numbers[y, x])
        page.tab.mouse.click(x, y)
        wait_for_titles(page, [f"Point {index}"])
        row_of = page.tab.locator(".wv-selection .wv-field-row", has_text="temperature")
        assert float(row_of.locator(".wv-field-value").inner_text()) == 0.1 * index
    viewer.do(SetProperty("display1", "enabled", False))


@pytest.mark.skipif(not BAG.exists(), reason="the bag of the TurtleBot 4 is absent")
def test_a_click_on_a_beam_of_a_real_scan_gets_its_index_range_and_intensity(
    viewer: webviz.Viewer, source: HandFedSource, page: Page
) -> None:
    with AnyReader([BAG], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        connections = [each for each in reader.connections if each.topic == "/scan"]
        _, _, data = next(reader.messages(connections))
    scan = decode("sensor_msgs/msg/LaserScan", bytes(data))
    source.now += 10_000_000_000
    viewer.do(SetFixedFrame(scan.header.frame_id))
    viewer.do(SetProperty("display3", "enabled", True))
    source.put("/scan", "sensor_msgs/msg/LaserScan", bytes(data))
    page.tab.keyboard.press("Escape")
    page.tab.keyboard.press("s")
    for beam in isolated_beams(scan)[::70][:2]:
        place = places_of(scan)[beam].tolist()
        view = {"type": "TopDownOrtho", "scale": 300.0, "x": place[0] - 0.3, "y": place[1] - 0.2}
        viewer.do(ShowView(checked_view(view)))
        page.draw()
        page.tab.mouse.click(*on_screen(page, place))
        wait_for_titles(page, [f"Beam {beam}"])
        text = page.tab.locator(".wv-selection").inner_text().split("\n")
        assert text[text.index("Range") + 1] == f"{scan.ranges[beam]!s} m"
        assert text[text.index("Intensity") + 1] == str(scan.intensities[beam])


def places_of(scan: Any) -> NDArray[np.float64]:
    """Return where each beam ends, in metres; NaN where it does not."""
    angles = scan.angle_min + np.arange(len(scan.ranges)) * scan.angle_increment
    ways = np.stack((np.cos(angles), np.sin(angles)), axis=1)
    places = scan.ranges.astype(np.float64)[:, None] * ways
    return np.where((scan.ranges < scan.range_max)[:, None], places, np.nan)


def isolated_beams(scan: Any) -> NDArray[np.intp]:
    """The beams whose points, drawn 2 cm wide, no other point touches."""
    places = places_of(scan)
    distances = np.linalg.norm(places[:, None] - places[None], axis=2)
    np.fill_diagonal(distances, np.inf)
    is_alone = np.nanmin(distances, axis=1, initial=np.inf) > 0.035
    return np.flatnonzero(is_alone & np.isfinite(places[:, 0]))


def test_clicks_on_markers_get_their_ids_texts_and_shapes_over_lines_included(
    viewer: webviz.Viewer, source: HandFedSource, page: Page
) -> None:
    """The camera is far above, where 20 cm are hardly nearer than the grid."""
    viewer.do(SetFixedFrame("map"))
    viewer.do(SetProperty("display4", "enabled", True))
    look = {"scale": {"x": 0.2, "y": 0.2, "z": 0.4}, "color": {"g": 1.0, "a": 1.0}}
    box, text = (2.0, 0.4), (-2.4, 1.4)
    markers = [
        {"id": 3, "type": 1, "pose": place(*box, 0.2), **look},
        {"id": 4, "type": 9, "pose": place(*text, 0.5), "text": "Dock", **look},
    ]
    array = {"markers": [{"ns": "room", "header": header("map", 0), **each} for each in markers]}
    source.put("/markers", MARKERS, encode(MARKERS, array))
    page.tab.keyboard.press("Escape")
    page.tab.keyboard.press("s")
    viewer.do(ShowView(checked_view({"type": "TopDownOrtho", "scale": 60.0})))
    page.draw()
    for at, title in ((box, "Marker room/3"), (text, "Marker room/4")):
        page.tab.mouse.click(*on_screen(page, at))
        wait_for_titles(page, [title])
    lines = page.tab.locator(".wv-selection").inner_text().split("\n")
    assert lines[lines.index("Type") + 1] == "TEXT_VIEW_FACING"
    assert lines[lines.index("Text") + 1] == "Dock"
    viewer.do(SetProperty("display4", "enabled", False))


def place(x: float, y: float, z: float) -> dict[str, Any]:
    return {"position": {"x": x, "y": y, "z": z}, "orientation": {"w": 1.0}}


def test_boxes_select_and_keys_add_and_remove(
    viewer: webviz.Viewer, source: HandFedSource, page: Page
) -> None:
    """Nine points, a metre from each other, and a grid below them, which no box takes."""
    viewer.do(SetFixedFrame("map"))
    viewer.do(SetProperty("display3", "enabled", False))
    page.tab.keyboard.press("Escape")
    page.tab.keyboard.press("s")
    viewer.do(ShowView(checked_view({"type": "TopDownOrtho", "scale": 60.0})))
    viewer.do(SetProperty("display1", "enabled", True))
    places = [(x, y, 0.0) for y in (-1.0, 0.0, 1.0) for x in (-1.0, 0.0, 1.0)]
    publish(source, "/cloud", "sensor_msgs/msg/PointCloud2", xyz_cloud(places))
    page.draw()
    tab = page.tab
    box(page, (-1.5, -1.5), (0.5, 0.5))
    wait_for_titles(page, ["Point 0", "Point 1", "Point 3", "Point 4"])
    rows = tab.locator(".wv-selection .wv-row").all_inner_texts()
    assert [row.split("\n") for row in rows[:4]] == [
        ["Cloud", "4 selected"],
        ["x in map", "-1 to 0, mean -0.5 m"],
        ["y in map", "-1 to 0, mean -0.5 m"],
        ["z in map", "0 to 0, mean 0 m"],
    ]
    box(page, (0.5, 0.5), (1.5, 1.5), "Shift")
    wait_for_titles(page, ["Point 0", "Point 1", "Point 3", "Point 4", "Point 8"])
    tab.keyboard.down("Control")
    tab.mouse.click(*on_screen(page, (0.0, 0.0)))
    tab.keyboard.up("Control")
    wait_for_titles(page, ["Point 0", "Point 1", "Point 3", "Point 8"])

    tab.mouse.click(*on_screen(page, (0.4, 0.6)))
    wait_for_titles(page, [])
    tab.mouse.click(*on_screen(page, (1.0, 0.0)))
    wait_for_titles(page, ["Point 5"])
    tab.keyboard.press("f")
    page.wait_for(lambda: np.allclose(on_screen(page, (1.0, 0.0)), middle(page), atol=2), "F")

    viewer.do(SetProperty("display1", "selectable", False))

    def picture_names() -> list[str]:
        tab.mouse.click(*on_screen(page, (0.0, 0.0)))
        return tab.locator(TITLE).all_inner_texts()

    # The grid is below it, and a click takes it.
    page.wait_for(lambda: picture_names() == ["Grid"], "a display that is not selectable")
    box(page, (-1.5, -1.5), (0.5, 0.5))
    viewer.do(SetProperty("display1", "selectable", True))
    page.wait_for(lambda: picture_names() == ["Point 4"], "a display that is selectable again")

    box(page, (-1.5, -1.5), (0.5, 0.5))
    wait_for_titles(page, ["Point 0", "Point 1", "Point 3", "Point 4"])
    assert tab.evaluate(MARKED)
    places = [(x + 0.3, y, z) for x, y, z in places]
    publish(source, "/cloud", "sensor_msgs/msg/PointCloud2", xyz_cloud(places))
    page.draw()
    assert tab.evaluate(MARKED)
    tab.evaluate("""() => {
      window.wasNow = performance.now;
      performance.now = () => window.wasNow.call(performance) + 11_000;
    }""")
    page.draw()
    page.wait_for(lambda: not tab.evaluate(MARKED), "no mark of what was replaced long ago")
    tab.evaluate("() => { performance.now = window.wasNow }")

    tab.keyboard.press("Escape")
    hint = tab.locator(".wv-pointer")
    tab.mouse.move(*on_screen(page, (0.3, 0.0)))
    page.wait_for(lambda: "Cloud · Point 4" in hint.inner_text(), "what is under the mouse")
    publish(source, "/cloud", "sensor_msgs/msg/PointCloud2", xyz_cloud([(2.0, 2.0, 0.0)]))
    page.draw()
    page.wait_for(lambda: "Cloud" not in hint.inner_text(), "what is there now, at rest")

    viewer.do(RemoveDisplay("display1"))
    wait_for_titles(page, [])
    tab.keyboard.press("Escape")
    page.wait_for(lambda: tab.locator(".wv-tool[aria-label=Select]").get_attribute("aria-pressed")
                  == "false", "Escape")  # fmt: skip


def wait_for_titles(page: Page, titles: list[str]) -> None:
    """Wait until the panel lists exactly these."""
    results: list[str] = []

    def is_so() -> bool:
        results[:] = page.tab.locator(TITLE).all_inner_texts()
        return sorted(results) == titles

    try:
        page.wait_for(is_so, "the selection", 60.0)
    except TimeoutError:
        assert results == titles


def on_screen(page: Page, xy: Sequence[float]) -> tuple[float, float]:
    """Return where a point of the ground is in the window."""
    return page.tab.evaluate(
        """async ([x, y]) => {
          const { onCanvas } = await import("webviz/scene/ground.js");
          const box = document.querySelector("canvas").getBoundingClientRect();
          const place = onCanvas([x, y, 0]);
          return [box.left + place[0], box.top + place[1]];
        }""",
        [float(xy[0]), float(xy[1])],
    )


def middle(page: Page) -> tuple[float, float]:
    """The middle of the scene in the window."""
    box = bounds(page.tab.locator("canvas").first)
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def box(page: Page, start: Sequence[float], end: Sequence[float], key: str = "") -> None:
    """Drag a box between two points of the ground."""
    first, last = on_screen(page, start), on_screen(page, end)
    if key:
        page.tab.keyboard.down(key)
    page.tab.mouse.move(*first)
    page.tab.mouse.down()
    page.tab.mouse.move(*last, steps=3)
    page.tab.mouse.up()
    if key:
        page.tab.keyboard.up(key)
