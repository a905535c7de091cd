"""`webviz export`: a run as one file, opened from the disk by a real browser."""

from __future__ import annotations

import base64
import contextlib
import io
import itertools
import math
import os
import random
import re
import signal
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import firefox
import msgspec
import numpy as np
import PIL.Image
import playwright.sync_api as playwright
import pytest
from bags import START_NS, Bag, ns
from drives import CONFIG, recorded
from pages import COARSE
from playwright.sync_api import expect

import webviz
from webviz.api.nodes import Pane
from webviz.api.views import VIEW_TYPES, Rig, View, like, mimic, type_of
from webviz.commands import Seek
from webviz.data.rotations import from_rpy
from webviz.shell.cli import main as cli
from webviz.shell.cli.options import MESH_ROOT
from webviz.shell.export.export import RunFile
from webviz.shell.pictures.browser_scripts import (
    CANVAS,
    COUNT_UNPACKING,
    OPAQUE,
    PIXEL,
    SETTLE,
)
from webviz.shell.pictures.headless_renderer import HeadlessRenderer
from webviz.shell.testing import BagViewer, header

TIMES = (1.0, 4.5, 0.5, 5.0, 2.0, 0.0)
SIZE: playwright.ViewportSize = {"width": 800, "height": 420}

MIMIC = """async (cases) => {
  const { like, mimic } = await import("webviz/recorded/view_math.js");
  return cases.map(([view, rig, type, newRig]) =>
    mimic(view, rig, like(type, view), newRig, 480));
}"""

BOX = """async () => {
  const viser = await import("webviz/viser_page.js");
  const { left, top, width, height } = viser.canvas().getBoundingClientRect();
  return [left, top, width, height];
}"""
COUNT_DONE = """async () => {
  const { on } = await import("webviz/channel.js");
  window.done = 0;
  on("CommandResult", () => (window.done += 1));
}"""
FOLLOW = """async (value) => {
  const { act } = await import("webviz/act.js");
  return act("ChangeView", { key: "target_frame", value });
}"""

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class OpenFile:
    """A file that a browser has opened from the disk, without a network.

    Args:
        page: an empty one.
        path: of the file.
        resolution: pixels of the scene per pixel of the page.
    """

    def __init__(self, page: playwright.Page, path: Path, resolution: float = 1.0) -> None:
        self.page = page
        self.requests: list[str] = []
        page.on("request", lambda request: self.requests.append(request.url))
        page.add_init_script(COUNT_UNPACKING)
        page.goto(f"{path.as_uri()}?fixedDpr={resolution}")  # also if the machine is slow
        page.wait_for_function("window.webviz?.hasView()")
        page.evaluate(COUNT_DONE)

    @contextlib.contextmanager
    def done(self) -> Iterator[None]:
        """Do something on the page, and wait until it is done and drawn."""
        before = self.page.evaluate("window.done")
        yield
        self.page.wait_for_function("(before) => window.done > before", arg=before)
        assert self.page.evaluate(SETTLE, 60_000.0)

    def seek(self, at_s: float) -> None:
        """Type a time, and wait until the page shows it."""
        field = self.page.get_by_label("Go to time")
        with self.done():
            field.fill(f"{at_s:g}")
            field.press("Enter")
        expect(field).to_have_value(f"0:00:0{at_s:.3f}")

    def pixels(self) -> np.ndarray:
        """The picture of the scene, uint8 (H, W, 3)."""
        png = base64.b64decode(self.page.evaluate(OPAQUE).split(",")[1])
        return np.asarray(PIL.Image.open(io.BytesIO(png)).convert("RGB"))


@pytest.fixture(scope="module", autouse=True)
def kept_process() -> Iterator[None]:
    """Take back what commands change in this process."""
    handlers = {number: signal.getsignal(number) for number in SIGNALS}
    meshes = os.environ.get(MESH_ROOT)
    yield
    for number, handler in handlers.items():
        signal.signal(number, handler)
    os.environ.pop(MESH_ROOT, None)
    if meshes is not None:
        os.environ[MESH_ROOT] = meshes


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a bag, its config, and the file that was exported."""
    folder = tmp_path_factory.mktemp("export")
    recorded().write(folder / "run")
    (folder / "lab.yaml").write_text(CONFIG)
    arguments = [str(folder / "run"), "-d", str(folder / "lab.yaml")]
    assert cli(["export", *arguments, "-o", str(folder / "run.html")]) == 0
    return folder


@pytest.fixture(scope="module")
def file(folder: Path, browser: playwright.Browser) -> Iterator[OpenFile]:
    """The file, opened."""
    context = browser.new_context(viewport=SIZE, offline=True, color_scheme="dark")
    yield OpenFile(context.new_page(), folder / "run.html")
    context.close()


def test_the_file_equals_captures_at_any_time_in_any_order(
    folder: Path, file: OpenFile, renderer: HeadlessRenderer
) -> None:
    file.seek(TIMES[0])  # the scene has its size by then
    size = tuple(file.page.evaluate(CANVAS))
    shots = webviz.capture(
        CONFIG, bag=folder / "run", at=sorted(TIMES), size=size, renderer=renderer
    )
    expected = {picture.at_s: picture.pixels for picture in shots.pictures}
    assert len({pixels.tobytes() for pixels in expected.values()}) == len(TIMES)
    for at_s in TIMES:
        file.seek(at_s)
        np.testing.assert_array_equal(file.pixels(), expected[at_s], f"at {at_s} s")


@pytest.mark.parametrize(
    ("how", "sentence"),
    [
        ("cut off within the modules", "This file is incomplete."),
        ("cut off within the recording", "This file is incomplete."),
        ("a changed byte", "This file is damaged, and shows only a part of its recording."),
        ("a changed index", "This file is damaged, and shows only a part of its recording."),
    ],
)
def test_a_damaged_file_reports_it(
    folder: Path, tmp_path: Path, browser: playwright.Browser, how: str, sentence: str
) -> None:
    whole = (folder / "run.html").read_bytes()
    chunk, about = (whole.index(b'type="webviz/%s">' % kind) for kind in (b"chunk", b"about"))
    damaged = {
        "cut off within the modules": whole[: len(whole) // 4],
        "cut off within the recording": whole[: chunk + 200],
        "a changed byte": whole[: chunk + 200] + b"@" + whole[chunk + 201 :],
        "a changed index": whole[: about + 40] + b"@" + whole[about + 41 :],
    }[how]
    (tmp_path / "run.html").write_bytes(damaged)
    context = browser.new_context(viewport=SIZE, offline=True)
    page = context.new_page()
    page.goto(f"{(tmp_path / 'run.html').as_uri()}?fixedDpr=0.1")
    expect(page.get_by_text(sentence)).to_be_visible()
    context.close()


def test_the_file_makes_no_requests(file: OpenFile) -> None:
    others = [url for url in file.requests if not url.startswith(("blob:", "data:"))]
    assert len(others) == 1


def test_displays_are_switched_off_and_on_also_in_other_frames(file: OpenFile) -> None:
    file.seek(3.0)
    before = file.pixels()
    switch = file.page.get_by_role("checkbox", name="Show Map")
    with file.done():
        switch.uncheck()
    assert not np.array_equal(file.pixels(), before)
    file.seek(1.0)
    without = file.pixels()
    with file.done():
        switch.check()
    assert not np.array_equal(file.pixels(), without)
    file.seek(3.0)
    np.testing.assert_array_equal(file.pixels(), before)


def test_actions_unavailable_in_a_file_are_disabled_with_the_reason(file: OpenFile) -> None:
    add = file.page.get_by_role("button", name="Add display")
    expect(add).to_have_attribute("aria-disabled", "true")
    expect(add).to_have_attribute("data-why", re.compile("Open the bag in webviz to change it"))


def test_views_change_as_in_a_viewer(file: OpenFile) -> None:
    chance = random.Random(3)
    cases: list[list[Any]] = []
    for name, cls in itertools.product(VIEW_TYPES, VIEW_TYPES.values()):
        view = msgspec.convert({"type": name, "target_frame": "base"}, View)
        if hasattr(view, "invert_z_axis"):
            view = msgspec.structs.replace(view, invert_z_axis=chance.random() < 0.5)
        rigs = [
            Rig((chance.uniform(-9, 9), 2.0, 0.5), from_rpy(0.0, 0.0, chance.uniform(-3, 3)))
            for _ in range(2)
        ]
        expected = mimic(view, rigs[0], like(cls, view), rigs[1], 480.0)
        arguments = [msgspec.to_builtins(view), asdict(rigs[0]), type_of(expected), asdict(rigs[1])]
        cases.append([arguments, msgspec.to_builtins(expected)])
    views = file.page.evaluate(MIMIC, [arguments for arguments, _ in cases])
    for view, (_, expected) in zip(views, cases, strict=True):
        assert view.keys() == expected.keys()
        for key, value in expected.items():
            assert view[key] == (
                value if isinstance(value, str | bool) else pytest.approx(value, abs=2e-6)
            )


def test_a_view_follows_a_frame_through_the_run(file: OpenFile) -> None:
    results = []
    file.page.evaluate(FOLLOW, "base")
    for at_s in (1.0, 4.0):
        file.seek(at_s)
        results.append(file.page.evaluate(PIXEL, [at_s, 0.0, 0.0]))
    file.page.evaluate(FOLLOW, "<Fixed Frame>")
    assert results[0] == pytest.approx(results[1], abs=3.0)
    assert file.page.evaluate(PIXEL, [1.0, 0.0, 0.0]) != pytest.approx(results[1], abs=30.0)


def test_a_box_selects_items_with_place_and_display(file: OpenFile) -> None:
    file.seek(2.0)
    page = file.page
    left, top, width, height = page.evaluate(BOX)
    page.keyboard.press("s")
    page.mouse.move(left + 40, top + height * 0.4)
    page.mouse.down()
    page.mouse.move(left + width - 2, top + height - 2, steps=3)
    page.mouse.up()
    element = page.locator(".wv-selection")
    expect(element.get_by_text("Odometry").first).to_be_attached()
    page.keyboard.press("Escape")


NOT_IN_THE_FILE = "not in the file. Open the bag in webviz to see them."


def test_a_map_is_selected_without_the_values_of_its_cells(file: OpenFile) -> None:
    file.seek(2.0)
    page = file.page
    page.keyboard.press("s")
    (left, top, width, _), (columns, rows) = page.evaluate(BOX), page.evaluate(CANVAS)
    # Next to what the robot publishes, and in the middle of the picture.
    places = (
        page.evaluate(PIXEL, [column + 0.3, row + 0.6, 0.0])
        for column, row in itertools.product(range(4), (1, 2, 3))
    )
    x, y = min(places, key=lambda each: math.dist(each, (columns / 2, rows / 2)))
    page.mouse.click(left + x * width / columns, top + y * width / columns)
    element = page.locator(".wv-selection")
    expect(element).to_contain_text("/map")
    expect(element).to_contain_text(NOT_IN_THE_FILE)
    page.keyboard.press("Escape")


SHOW = """
const [at] = arguments;
const field = document.querySelector("[aria-label='Go to time']");
field.value = String(at);
field.dispatchEvent(new Event("change", { bubbles: true }));
"""
IS_SHOWN = "return document.querySelector(\"[aria-label='Go to time']\").value === arguments[0]"


def differing(first: np.ndarray, second: np.ndarray) -> int:
    """The number of pixels that are not the same, apart from rounding."""
    if first.shape != second.shape:
        return max(first.size, second.size)
    return int((abs(first.astype(int) - second) > 4).any(axis=-1).sum())


def test_firefox_shows_the_file_in_any_order_without_a_network(
    folder: Path, tmp_path: Path
) -> None:
    with firefox.open_firefox(tmp_path) as tab:
        tab.open(folder / "run.html")
        tab.wait_for("return window.webviz?.hasView()")
        tab.run("document.getElementById('webviz').style.visibility = 'hidden'")

        def pixels_at(at_s: float) -> np.ndarray:
            tab.run(SHOW, at_s)
            tab.wait_for(IS_SHOWN, f"0:00:0{at_s:.3f}")
            before, pixels = np.empty(0), tab.pixels("canvas")
            while differing(before, pixels):  # it draws on its own
                before, pixels = pixels, tab.pixels("canvas")
            return pixels

        first, second = pixels_at(1.0), pixels_at(4.0)
        assert differing(first, second) > 100
        assert len(np.unique(first.reshape(-1, 3), axis=0)) > 20
        assert differing(pixels_at(1.0), first) == 0
        names = "return performance.getEntriesByType('resource').map(({ name }) => name)"
        assert [name for name in tab.run(names) if not name.startswith(("blob:", "data:"))] == []


def test_a_click_shows_the_values_of_a_point(file: OpenFile) -> None:
    file.seek(2.0)
    page = file.page
    page.keyboard.press("s")
    # Of the scan before: the transform at the stamp of this one comes later.
    x, y = page.evaluate(PIXEL, [1.9 + 2.0 * math.cos(0.1), 2.0 * math.sin(0.1), 0.0])
    (left, top, width, _), (columns, _) = page.evaluate(BOX), page.evaluate(CANVAS)
    page.mouse.click(left + x * width / columns, top + y * width / columns)
    element = page.locator(".wv-selection")
    expect(element).to_contain_text(re.compile(r"Beam 1.*Range\s*2 m", re.DOTALL))
    expect(element).to_contain_text(re.compile(r"Angle\s*0\.100000 rad, 5\.73°"))
    page.keyboard.press("Escape")


@pytest.fixture(scope="module")
def clouds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A bag of clouds by chance, 2 MB in half a second, and a config that shows them."""
    folder = tmp_path_factory.mktemp("clouds")
    bag = Bag()
    bag.add("/points", "sensor_msgs/msg/PointCloud2", best_effort=True)
    bag.transform(0, "map", "lidar", static=True)
    for step in range(5):
        bag.put(step / 10, "/points", cloud_of(points(step), START_NS + ns(step / 10)))
    bag.write(folder / "run")
    (folder / "lab.yaml").write_text("fixed_frame: map\ndisplays:\n- {type: PointCloud2}\n")
    return folder


POINT = np.dtype(
    [
        ("x", "<f4"),
        ("y", "<f4"),
        ("z", "<f4"),
        ("intensity", "<f4"),
        ("rgb", "<u4"),
        ("ring", "<u2"),
    ]
)
DATATYPES = {"<f4": 7, "<u4": 6, "<u2": 4}


def points(step: int) -> np.ndarray:
    """20 000 points by chance, the first of which cannot be drawn."""
    chance = np.random.default_rng(step)
    points = np.empty(20_000, POINT)
    for axis in "xyz":
        points[axis] = chance.uniform(-5.0, 5.0, len(points))
    points["x"][0] = np.nan
    points["intensity"] = chance.integers(0, 256, len(points)) / np.float32(3.0)
    points["rgb"] = chance.integers(0, 1 << 24, len(points))
    points["ring"] = np.arange(len(points)) % 64
    return points


def cloud_of(points: np.ndarray, stamp_ns: int) -> dict[str, Any]:
    fields = [
        {"name": name, "offset": offset, "datatype": DATATYPES[dtype.str], "count": 1}
        for name, (dtype, offset, *_) in (POINT.fields or {}).items()
    ]
    return {
        "header": header("lidar", stamp_ns),
        "height": 1,
        "width": len(points),
        "fields": fields,
        "point_step": POINT.itemsize,
        "row_step": points.nbytes,
        "data": points.view(np.uint8),
    }


def test_a_file_keeps_its_limit_and_reports_thinning(
    clouds: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    arguments = ["export", str(clouds / "run"), "-d", str(clouds / "lab.yaml")]
    sizes = {}
    for limit in ("50MB", "3MB"):
        path = clouds / f"{limit}.html"
        assert cli([*arguments, "-o", str(path), "--max-size", limit]) == 0
        sizes[limit] = path.stat().st_size, capfd.readouterr().err
    whole, warnings = sizes["50MB"]
    assert (whole > 3_500_000, warnings) == (True, "")
    thinned, warnings = sizes["3MB"]
    assert thinned <= 3_000_000
    assert "Clouds keep at least one of" in warnings
    assert "Values of selected points are missing between 0.0 and" in warnings
    page = RunFile(io.BytesIO()).client_bytes
    more, less = f"{page // 1000 + 1}kB", f"{page // 1000}kB"
    assert cli([*arguments, "-o", str(clouds / "few.html"), "--max-size", more]) == 0
    assert "Choose a shorter span, or fewer displays." in capfd.readouterr().err
    assert cli([*arguments, "-o", str(clouds / "none.html"), "--max-size", less]) == 2
    assert capfd.readouterr().err == (
        f"webviz: --max-size is less than the {page / 1e6:.1f} MB of the page itself. "
        "Choose a larger one.\n"
    )
    assert not (clouds / "none.html").exists()


def test_a_point_of_a_large_cloud_refers_to_the_bag_for_its_values(
    clouds: Path, browser: playwright.Browser
) -> None:
    path = clouds / "50MB.html"
    if not path.exists():
        arguments = [str(clouds / "run"), "-d", str(clouds / "lab.yaml"), "-o", str(path)]
        assert cli(["export", *arguments]) == 0
    with browser.new_context(viewport=SIZE, offline=True) as context:
        file = OpenFile(context.new_page(), path)
        file.seek(0.4)
        page = file.page
        page.keyboard.press("s")
        left, top, width, height = page.evaluate(BOX)
        page.mouse.click(left + width / 2, top + height / 2)
        element = page.locator(".wv-selection")
        expect(element).to_contain_text("lidar")
        expect(element).to_contain_text(NOT_IN_THE_FILE)
        expect(element).not_to_contain_text("Position")


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--from", "4", "--to", "2"), "--from 4 s is later than --to 2 s. Swap them."),
        (("--to", "99"), "99 s is outside of"),
        (("-o", "missing/run.html"), "Cannot write missing/run.html: No such file or directory."),
    ],
)
def test_a_failed_export_is_one_sentence_and_writes_no_file(
    folder: Path,
    arguments: tuple[str, ...],
    sentence: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    output = () if "-o" in arguments else ("-o", "run.html")
    assert cli(["export", str(folder / "run"), *arguments, *output]) == 1
    error = capfd.readouterr().err
    assert sentence in error
    assert len(error.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


EVIL = "</script><script>alert(1)</script><img src=x onerror=alert(2)>"
HOSTILE = f"""\
version: 1
fixed_frame: map
displays:
- {{type: Image, topic: /image, annotations_topic: /found, name: "{EVIL}"}}
- {{type: Marker, topic: /markers}}
panels:
- {{type: Plot, curves: ["/odom.pose.pose.position.x"]}}
"""


def hostile() -> Bag:
    """Annotated images, an odometry and markers whose texts are markup, some at no place."""
    bag = Bag()
    bag.add("/image", "sensor_msgs/msg/Image")
    bag.add("/found", "vision_msgs/msg/Detection2DArray")
    bag.add("/markers", "visualization_msgs/msg/Marker")
    bag.add("/odom", "nav_msgs/msg/Odometry")
    bag.add("/rosout", "rcl_interfaces/msg/Log")
    bag.transform(0, "map", EVIL[:30], static=True)
    for step in range(20):
        about = header("map", START_NS + ns(step / 10))
        place = {"position": {"x": [step / 10, np.nan][step % 2]}, "orientation": {"w": 1.0}}
        marker = {"ns": EVIL, "type": 9, "text": EVIL, "scale": {"z": 0.5}, "color": {"a": 1.0}}
        bag.put(step / 10, "/markers", {"header": about, "pose": place, **marker})
        bag.put(step / 10, "/odom", {"header": about, "pose": {"pose": place}})
        box = {
            "center": {"position": {"x": 8.0, "y": 8.0}},
            "size_x": 2.0 + step % 9,
            "size_y": 12.0,
        }
        results = [{"hypothesis": {"class_id": f"{step}{EVIL}", "score": 0.5}}]
        detection = {"bbox": box, "results": results}
        bag.put(step / 10, "/found", {"header": about, "detections": [detection]})
        bag.put(step / 10, "/rosout", {"level": 40, "name": EVIL, "msg": EVIL})
        pixels = np.full(16 * 48, 10 * step, np.uint8)
        size = {"width": 16, "height": 16, "step": 48, "encoding": "rgb8"}
        bag.put(step / 10, "/image", {"header": about, **size, "data": pixels})
    return bag


MARKED_PIXELS = """() => {
  const canvas = document.querySelector(".wv-pane-marks");
  const { width, height } = canvas;
  const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
  return data.filter((byte) => byte).length;
}"""


def pane_of(viewer: BagViewer) -> Pane:
    """The only pane that a viewer draws."""
    snapshots = [
        each for runner in viewer.loop.runners() for *_, each in runner.scene_diff.snapshots()
    ]
    groups = [group for snapshot in snapshots for group in snapshot.groups.values()]
    (pane,) = [node for each in groups for node in each.nodes.values() if isinstance(node, Pane)]
    return pane


def test_images_and_plots_are_in_the_file_and_no_text_becomes_markup(
    browser: playwright.Browser, tmp_path: Path
) -> None:
    hostile().write(tmp_path / "run")
    (tmp_path / "lab.yaml").write_text(HOSTILE)
    path = tmp_path / "run.html"
    assert (
        cli(["export", str(tmp_path / "run"), "-d", str(tmp_path / "lab.yaml"), "-o", str(path)])
        == 0
    )
    assert b"onerror=alert" not in path.read_bytes()
    context = browser.new_context(viewport=SIZE, offline=True)
    page = context.new_page()
    texts: list[str] = []

    def dismiss(dialog: playwright.Dialog) -> None:
        texts.append(dialog.message)
        dialog.dismiss()

    page.on("dialog", dismiss)
    open_file = OpenFile(page, path, COARSE)
    with contextlib.closing(BagViewer(tmp_path / "run", HOSTILE)) as viewer:
        for at_s in (1.5, 0.3):
            open_file.seek(at_s)
            viewer.do(Seek(at_s))
            (mark,) = pane_of(viewer).marks
            assert f"{at_s * 10:.0f}</script>" in mark.about
            page.locator(".wv-pane canvas").first.hover()
            expect(page.locator(".wv-pane")).to_contain_text(mark.about)
            assert page.evaluate(MARKED_PIXELS) > 0
    open_file.seek(1.0)
    stamp = (START_NS + ns(1.0)) / 1e9
    pane = page.locator(f".wv-pane[data-stamp='{stamp:.0f}']")
    expect(pane).to_have_count(1)
    pane.locator("canvas").first.hover()
    expect(pane).to_contain_text("rgb 100 100 100")
    page.evaluate("document.getElementById('wv-tab-plugin-Plot').click()")
    expect(page.locator(".wv-panel")).to_contain_text("/odom.pose.pose.position.x")
    context.close()
    assert texts == []
