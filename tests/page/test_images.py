"""Images beside the scene, in a real browser: what is sent, decoded and drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import photos
import pytest

from tests.page.image_panes import (
    COLORS,
    DEPTHS,
    VIDEO,
    hover,
    id_of,
    images_in,
    middle,
    near,
    pane,
    pane_color,
    publish,
    rgba,
    send,
    show_images,
)
from tests.page.page_bench import PageBench, PageServer
from tests.page.tabs import ViewerTab
from webviz.commands import SetProperty
from webviz.scene import ViserScene

ANNOTATIONS, DETECTIONS = "foxglove_msgs/msg/ImageAnnotations", "vision_msgs/msg/Detection2DArray"


@pytest.fixture(scope="module")
def scene(page_server: PageServer) -> ViserScene:
    return page_server.scene


@pytest.fixture
def pictures(scene: ViserScene, monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int]]:
    """The display and the size of each picture that is sent."""
    pictures: list[tuple[str, int]] = []
    send = scene.link.channel.send_bytes

    def noting(data: bytes, key: str, browser: int) -> None:
        pictures.append((key.rpartition(" ")[0], len(data)))
        send(data, key, browser)

    monkeypatch.setattr(scene.link.channel, "send_bytes", noting)
    return pictures


@pytest.fixture
def tab(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[ViewerTab]:
    """The tab with two images."""
    with images_in(viewer, viewer_tab) as tab:
        yield tab


@pytest.fixture(scope="module")
def other(open_lasting_viewer_tab: Callable[..., ViewerTab]) -> ViewerTab:
    """Another tab, which draws the scene at the size of the page."""
    return open_lasting_viewer_tab(700, 560, resolution=1.0)


def of(viewer: PageBench, name: str, pictures: list[tuple[str, int]]) -> list[int]:
    """The sizes of the pictures of a display that were sent."""
    return [size for display, size in pictures if display == id_of(viewer, name)]


def test_pictures_have_their_colors_and_hovering_reads_values(tab: ViewerTab) -> None:
    assert near(pane_color(tab, "Color"), COLORS[108, 80])
    assert near(pane_color(tab, "Depth", (0.02, 0.02)), (0, 0, 0))  # no measurement
    tab.wait_for(lambda: f"x 40 · y 100 · {DEPTHS[100, 40]:.3f} m" in hover(tab, "Depth", 40, 100))
    tab.wait_for(lambda: "no measurement" in hover(tab, "Depth", 2, 2))
    red, green, blue = COLORS[72, 96]
    tab.wait_for(lambda: f"{red} {green} {blue}" in hover(tab, "Color", 96, 72))
    assert "0.5 m" in pane(tab, "Depth").locator(".wv-pane-legend").inner_text()
    assert not pane(tab, "Color").locator(".wv-pane-legend").is_visible()


def test_only_what_is_shown_is_sent_and_only_the_newest(
    tab: ViewerTab,
    scene: ViserScene,
    pictures: list[tuple[str, int]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("webviz.server.images.pictures.UNSEEN_S", 0.0)
    viewer = tab.viewer
    color, depth = id_of(viewer, "Color"), id_of(viewer, "Depth")
    pane(tab, "Depth").get_by_role("button", name="Collapse /depth").click()
    assert not scene.is_unseen(depth)
    tab.wait_for(lambda: scene.is_unseen(depth))
    assert not scene.is_unseen(color)
    pictures.clear()
    for number in range(2, 102):
        publish(viewer, "Color", np.full_like(COLORS, number), "rgb8")
        publish(viewer, "Depth", DEPTHS, "32FC1")
    tab.wait_for(lambda: near(pane_color(tab, "Color"), (101, 101, 101), 3))
    assert not of(viewer, "Depth", pictures)
    assert len(of(viewer, "Color", pictures)) < 100
    pane(tab, "Depth").get_by_role("button", name="Expand /depth").click()
    tab.wait_for(lambda: of(viewer, "Depth", pictures))
    assert not scene.is_unseen(depth)


def test_jpeg_is_decoded_by_the_page_and_swapped_if_it_must(tab: ViewerTab) -> None:
    viewer, red = tab.viewer, np.full((120, 160, 3), (200, 60, 20), np.uint8)
    show_images(viewer, photos.COMPRESSED)
    send(viewer, "Color", photos.COMPRESSED, photos.jpeg(red))
    tab.wait_for(lambda: near(pane_color(tab, "Color"), (200, 60, 20)))
    tab.wait_for(lambda: "rgb 20" in hover(tab, "Color", 5, 5).replace("rgb 199", "rgb 200"))
    # What a publisher of RGB names BGR has red and blue exchanged.
    swapped = photos.jpeg(red, "bgr8; jpeg compressed rgb8")
    send(viewer, "Color", photos.COMPRESSED, swapped)
    tab.wait_for(lambda: near(pane_color(tab, "Color"), (20, 60, 200)))
    damaged = photos.jpeg(red)
    data = damaged["data"].copy()
    data[data.tobytes().index(b"\xff\xc4") :] = 0  # all behind the size
    send(viewer, "Color", photos.COMPRESSED, damaged | {"data": data})
    problem = pane(tab, "Color").locator(".wv-pane-problem")
    tab.wait_for(
        lambda: problem.is_visible() and "cannot decode this image/jpeg" in problem.inner_text()
    )
    send(viewer, "Color", photos.COMPRESSED, photos.jpeg(COLORS))
    tab.wait_for(
        lambda: near(pane_color(tab, "Color"), COLORS[108, 80]) and not problem.is_visible()
    )


def test_marks_lie_over_the_picture_and_follow_the_zoom(
    tab: ViewerTab, pictures: list[tuple[str, int]]
) -> None:
    viewer = tab.viewer
    marks = pane(tab, "Color").locator(".wv-pane-marks")
    viewer.offer("/marks", ANNOTATIONS, "/detector")
    choose(viewer, "/marks")
    annotate(viewer, fill=(0.0, 0.0, 1.0))
    tab.wait_for(lambda: color_of(marks, tab, 60, 45) == [0, 0, 255, 255])
    assert max(of(viewer, "Color", pictures)) > 500
    pictures.clear()
    annotate(viewer, fill=(1.0, 0.0, 0.0))
    tab.wait_for(lambda: color_of(marks, tab, 60, 45) == [255, 0, 0, 255])
    assert max(of(viewer, "Color", pictures)) < 500, "The picture is not sent again for its marks."
    assert color_of(marks, tab, 60, 30) == [0, 255, 0, 255]
    assert color_of(marks, tab, 100, 45) == [0, 0, 0, 0]
    viewer.offer("/boxes", DETECTIONS, "/detector")
    choose(viewer, "/boxes")
    box = {"center": {"position": {"x": 60.0, "y": 45.0}}, "size_x": 40.0, "size_y": 30.0}
    viewer.publish("/boxes", DETECTIONS, {"detections": [{"id": "7", "bbox": box}]})
    tab.wait_for(lambda: "Detection 7 · 40 x 30 px" in hover(tab, "Color", 60, 45))
    tab.wait_for(lambda: "Detection" not in hover(tab, "Color", 110, 100))
    choose(viewer, "/marks")
    annotate(viewer, fill=(1.0, 0.0, 0.0))
    hover(tab, "Color", 60, 45)
    tab.page.mouse.wheel(0, -500)  # doubles it around the mouse
    tab.wait_for(lambda: color_of(marks, tab, 60, 22) == [255, 0, 0, 255])
    tab.page.mouse.dblclick(*middle(tab))
    choose(viewer, "")
    tab.wait_for(lambda: marks.count() == 0)


def choose(viewer: PageBench, annotations: str) -> None:
    """Choose the topic of annotations of "Color", which begins anew."""
    color = id_of(viewer, "Color")
    viewer.do(SetProperty(color, "annotations_topic.name", annotations))
    publish(viewer, "Color", COLORS, "rgb8")


def annotate(viewer: PageBench, fill: tuple[float, float, float]) -> None:
    """Publish a filled box with a green edge."""
    corners = [{"x": x, "y": y} for x, y in ((40, 30), (80, 30), (80, 60), (40, 60))]
    colors = {"outline_color": rgba(0.0, 1.0, 0.0), "fill_color": rgba(*fill)}
    box = {"type": 2, "points": corners, "thickness": 4.0, **colors}
    viewer.publish("/marks", ANNOTATIONS, {"points": [box]})
    viewer.turn()


def color_of(marks: Any, tab: ViewerTab, x: float, y: float) -> list[int]:
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


def test_video_is_decoded_by_the_page(tab: ViewerTab) -> None:
    viewer = tab.viewer
    recorded = tab.page.evaluate(RECORD, "vp09.00.10.08")
    assert recorded is not None

    def play(first: int, last: int) -> None:
        for data in recorded[first:last]:
            send(viewer, "Color", VIDEO, {"format": "vp9", "data": data})

    show_images(viewer, VIDEO)
    play(0, 2)
    tab.wait_for(lambda: near(pane_color(tab, "Color"), (80, 40, 40), 25))
    play(2, 5)
    tab.wait_for(lambda: near(pane_color(tab, "Color"), (200, 40, 40), 25))
    problem = pane(tab, "Color").locator(".wv-pane-problem")
    damaged = {"format": "h264", "data": [0, 0, 0, 1, 0x65, *[0] * 50]}  # a key frame of nothing

    def again() -> bool:
        send(viewer, "Color", VIDEO, damaged)
        return problem.is_visible()

    tab.wait_for(again)
    play(0, 5)
    tab.wait_for(
        lambda: near(pane_color(tab, "Color"), (200, 40, 40), 25) and not problem.is_visible()
    )


def test_a_picture_that_is_decoded_later_is_not_drawn_over_a_newer_one(tab: ViewerTab) -> None:
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
    publish(tab.viewer, "Color", np.full_like(COLORS, 200), "rgb8")
    tab.wait_for(lambda: tab.page.evaluate("window.isDecoding"))
    publish(tab.viewer, "Color", np.full_like(COLORS, 100), "rgb8")
    tab.turn()
    tab.page.evaluate("window.decodeIt()")
    tab.wait_for(lambda: near(pane_color(tab, "Color"), (100, 100, 100), 3))
    tab.page.wait_for_function("window.isLate")
    assert near(pane_color(tab, "Color"), (100, 100, 100), 3)


def test_two_pages_and_a_flood_leave_no_queue(
    tab: ViewerTab, pictures: list[tuple[str, int]], other: ViewerTab
) -> None:
    other.wait_for(lambda: pane_color(other, "Color") and pane_color(other, "Depth"))
    for _ in range(FLOOD):
        publish(tab.viewer, "Color", COLORS, "rgb8")
    publish(tab.viewer, "Color", np.full_like(COLORS, 7), "rgb8")
    for each in (tab, other):
        each.wait_for(lambda each=each: near(pane_color(each, "Color"), (7, 7, 7), 3))
    assert len(pictures) < FLOOD, "A page is sent the next one once it has shown one before."


FLOOD = 600
"""Pictures, for two pages each."""
