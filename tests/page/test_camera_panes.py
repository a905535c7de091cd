"""The scene over the image of a camera, as that camera sees it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import lenses
import numpy as np
import photos
import pytest

from tests.page.image_panes import (
    FORGETFUL,
    rgba,
)
from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.api.declared import Topic
from webviz.commands import RemoveDisplay, SetProperty
from webviz.data.images import CameraModel
from webviz.data.messages import decode, encode
from webviz.shell.testing.messages import header, stamped_transform
from webviz_displays.camera import Camera
from webviz_displays.markers import MarkerArray


@pytest.fixture(scope="module")
def other(open_lasting_viewer_tab: Callable[..., ViewerTab]) -> ViewerTab:
    """Another tab, which draws the scene at the size of the page."""
    return open_lasting_viewer_tab(700, 560, resolution=1.0)


EYE = (5.0, 6.0, 7.0)
"""Position of the camera in the fixed frame, in metres."""
CHOSEN = {"red": (2, (255, 0, 0)), "green": (3, (0, 255, 0)), "blue": (1, (0, 0, 255))}
"""Numbers of rays of the rectified camera, and colours of points there."""


def show_camera(viewer: PageBench) -> None:
    """Show a camera, whose image has each point in the pixel in which OpenCV sees it."""
    info = lenses.info("plumb_bob")
    model = CameraModel.whole(decode(photos.INFO, encode(photos.INFO, info)))
    # The camera of a stereo pair whose centre is beside its frame.
    mounted = EYE[0] - model.center[0], EYE[1] - model.center[1], EYE[2]
    static = {"transforms": [stamped_transform("map", "camera", 0, mounted)]}
    viewer.publish("/tf_static", "tf2_msgs/msg/TFMessage", static)
    _, _, pixels_of_rays = lenses.CAMERAS["plumb_bob"]
    pixels = np.zeros((lenses.HEIGHT, lenses.WIDTH, 3), np.uint8)
    for index, color in CHOSEN.values():
        column, row = map(round, pixels_of_rays[index])
        pixels[row - 7 : row + 8, column - 7 : column + 8] = color
    topic = Topic("/camera/image_raw")
    camera = Camera(
        name="Camera",
        topic=topic,
        image_rendering="overlay",
        overlay_alpha=0.0,
        zoom_factor=0.75,
    )
    names = [name.title() for name in CHOSEN]
    markers = (MarkerArray(name=name, topic=Topic(f"/{name.lower()}")) for name in names)
    viewer.show(camera, *markers, background=(0, 0, 0), memory=FORGETFUL)
    viewer.turn()
    for name, (index, color) in CHOSEN.items():
        place = np.array(EYE) + 2.0 * lenses.RAYS[index]
        dot = marker(8, color, place, 0.06) | {"points": [dict(zip("xyz", place, strict=True))]}
        text = [marker(9, (255, 255, 255), np.add(EYE, (0.0, 0.0, 2.0)), 0.3) | {"text": "Text"}]
        markers_of = [dot, *(text if name == "red" else [])]
        viewer.publish(f"/{name}", "visualization_msgs/msg/MarkerArray", {"markers": markers_of})
    stamped = {"header": header("camera", viewer.source.now)}
    viewer.publish("/camera/camera_info", photos.INFO, info | stamped)
    viewer.publish(topic.name, photos.RAW, photos.raw(pixels, "rgb8") | stamped)
    viewer.turn()


def marker(type_: int, color: Any, place: Any, size: float) -> dict[str, Any]:
    """A marker; that of a text stands at the place."""
    red, green, blue = (each / 255 for each in color)
    position = dict(zip("xyz", place if type_ == 9 else (0.0, 0.0, 0.0), strict=True))
    return {
        "header": {"frame_id": "map"},
        "id": type_,
        "type": type_,
        "pose": {"position": position, "orientation": {"w": 1.0}},
        "scale": dict.fromkeys("xyz", size),
        "color": rgba(red, green, blue),
    }


def test_the_scene_is_over_the_image_where_the_camera_sees_it(
    viewer: PageBench, other: Any
) -> None:
    show_camera(viewer)
    chosen, pixels_of_rays = CHOSEN, lenses.CAMERAS["plumb_bob"][2]
    camera = CameraModel.whole(decode(photos.INFO, encode(photos.INFO, lenses.info("plumb_bob"))))

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

    camera_id = viewer.id("Camera")
    other.wait_for(lambda: are_right({"red", "green", "blue"}, has_text=True))  # of the scene
    viewer.do(SetProperty(camera_id, "visibility", {"Red": False}))
    other.wait_for(lambda: are_right({"green", "blue"}))
    for name in ("Red", "Green", "Blue"):
        viewer.do(RemoveDisplay(viewer.id(name)))
    other.wait_for(lambda: are_right(set()))
    # Of the image alone, undistorted: it fits the scene.
    viewer.do(SetProperty(camera_id, "overlay_alpha", 1.0))
    other.wait_for(lambda: are_right({"red", "green", "blue"}))
    result = dots()
    x, y = (result["blue"][i] / result["size"][i] for i in range(2))
    canvas = other.page.get_by_label("Image /camera/image_raw", exact=True).locator("canvas")
    box = canvas.bounding_box()
    column, row = map(round, pixels_of_rays[1])
    value = other.page.get_by_label("Image /camera/image_raw", exact=True).locator(".wv-pane-value")

    def reads() -> bool:
        other.page.mouse.move(box["x"] + x * box["width"], box["y"] + y * box["height"])
        words = value.inner_text().split()
        if len(words) < 8 or words[-3:] != ["0", "0", "255"]:
            return False
        return abs(int(words[1]) - column) <= 3 and abs(int(words[4]) - row) <= 3

    other.wait_for(reads)


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
