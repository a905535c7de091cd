"""Images on a plane in the scene, without a browser."""

from __future__ import annotations

from typing import Any

import numpy as np
import photos
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import image_planes
from inspecting import Benches

from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.image_plane import ImagePlane
from webviz_displays.shared.geometry import transformed

SECOND = 1_000_000_000
COLORS, DEPTHS = photos.room(16, 12)


def bench_with(
    bench: Benches, values: dict[str, Any], type_: str = photos.RAW, **properties: Any
) -> DisplayBench:
    at = bench(ImagePlane(**properties))
    at.transform("map", "camera", (1.0, 2.0, 3.0))
    at.send(type_, values, frame="camera")
    at.turn()
    return at


@pytest.mark.parametrize(
    ("plane", "upper_left", "lower_right"),
    [
        ("Optical", (-1.0, -0.75, 0.0), (1.0, 0.75, 0.0)),
        ("XY", (-1.0, 0.75, 0.0), (1.0, -0.75, 0.0)),
        ("XZ", (-1.0, 0.0, 0.75), (1.0, 0.0, -0.75)),
        ("YZ", (0.0, -1.0, 0.75), (0.0, 1.0, -0.75)),
    ],
)
def test_the_centre_is_the_origin_of_the_frame(
    bench: Benches,
    plane: str,
    upper_left: tuple[float, float, float],
    lower_right: tuple[float, float, float],
) -> None:
    at = bench_with(bench, photos.raw(COLORS, "rgb8"), plane=plane, width=2.0)
    assert (at.statuses()["Image"][0] == "OK") == ("image" in at.nodes())
    at.settle()
    assert at.statuses()["Image"] == ("OK", "16 x 12, rgb8.")
    image, pose = at.nodes()["image"], at.poses()["image"]
    places = np.array([(0.0, 0.0, 0.0), (image.width, image.height, 0.0)])
    cells = image.cells
    if plane != "Optical":  # row 0 lies along y = 0
        cells, places[:, 1] = cells[::-1], places[::-1, 1]
    np.testing.assert_array_equal(cells[..., :3], COLORS)
    expected = np.add([upper_left, lower_right], (1.0, 2.0, 3.0))
    np.testing.assert_allclose(transformed(pose, places), expected, atol=1e-6)


def test_large_images_are_sent_as_small_textures(bench: Benches) -> None:
    values = photos.jpeg(photos.room(1001, 500)[0])
    at = bench_with(bench, values, photos.COMPRESSED, width=2.0, alpha=0.5)
    at.settle()
    image = at.nodes()["image"]
    assert image.cells.shape == (125, 251, 4)
    assert (image.width, image.height) == pytest.approx((2.0, 1000 / 1001))
    assert (image.cells[..., 3] == 128).all()
    assert at.statuses()["Image"] == ("OK", "1001 x 500, jpeg.")


@pytest.mark.parametrize(
    ("type_", "values", "properties", "sentence"),
    [
        (photos.RAW, photos.raw(COLORS, "rgb9"), {}, "did you mean rgb8?"),
        (
            photos.COMPRESSED,
            {"format": "jpeg", "data": photos.jpeg(COLORS)["data"][:-99]},
            {},
            "The image/jpeg is damaged",
        ),
        (photos.RAW, photos.raw(COLORS, "rgb8"), {"width": 1e308}, "Reduce its width."),
    ],
)
def test_invalid_images_are_reported(
    bench: Benches, type_: str, values: Any, properties: dict[str, Any], sentence: str
) -> None:
    at = bench_with(bench, values, type_, **properties)
    at.settle()
    level, text = at.statuses()["Image"]
    assert (level, sentence in text) == ("ERROR", True), text
    assert at.nodes() == {}
    if properties:
        at.press("Image")


def test_every_image_lies_where_its_frame_was(bench: Benches) -> None:
    """Also those that have to be decompressed, and what comes on the same topic after them."""
    at = bench(ImagePlane(normalize_range=False, max_value=255.0, width=2.0))
    observed = set()
    for value in (10, 20, 30, 40):
        at.transform("map", "camera", (float(value), 0.0, 0.0), stamp_ns=value * SECOND)
        if value <= 20:
            type_, values = photos.COMPRESSED, photos.png16(np.full((12, 16), value, np.uint16))
        else:
            type_, values = photos.RAW, photos.raw(np.full((12, 16), value, np.uint8), "mono8")
        at.send(type_, values, frame="camera", stamp_ns=value * SECOND)
        at.turn()
        while value >= 20 and at.runner.is_busy():
            at.turn()
            if image := at.nodes().get("image"):
                observed.add((int(image.cells[0, 0, 0]), at.poses()["image"].position[0] + 1.0))
    assert observed <= {(value, float(value)) for value in (10, 20, 30, 40)}
    assert {(20, 20.0), (30, 30.0), (40, 40.0)} <= observed


class TestImagePlane(BuiltInChecks):
    display = ImagePlane
    scene = image_planes
    later = ("median_window",)


def test_selecting_pixel_of_a_depth_image(bench: Benches) -> None:
    """The third column and the second row from the top, of 4 x 3 pixels that are 0.5 m large."""
    at = bench(ImagePlane(plane="XY", width=2.0))
    depths = np.arange(12, dtype=np.float32).reshape(3, 4) / 4
    at.send(photos.RAW, photos.raw(depths, "32FC1"), frame="map")
    at.turn()
    at.settle()
    check_details(at.pick("image", None, (1.2, 0.6, 0.0)), "Pixel 2, 1", {"Value": "1.5"})
