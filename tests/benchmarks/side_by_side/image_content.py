"""Images of the scenes, as nested mappings with gaps for stamps and marks."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import PIL.Image
from numpy.typing import NDArray

from side_by_side import strip
from side_by_side.content import Values, static
from side_by_side.marks import PER_METRE, Lane, Place
from side_by_side.streams import Stream, header

IMAGE = "sensor_msgs/msg/Image"
COMPRESSED = "sensor_msgs/msg/CompressedImage"
INFO = "sensor_msgs/msg/CameraInfo"
TF = "tf2_msgs/msg/TFMessage"
VARIANTS = 32
"""Of images whose marks are inside what is compressed or computed from them."""
FOCAL = 500.0


def raw(width: int, height: int) -> list[Stream]:
    """Images of rgb8 at 30 Hz with a strip in their corner."""
    made = []
    for variant in range(2):
        pixels = _picture(width, height, variant)
        pixels[: strip.BLOCK, : strip.LENGTH * strip.BLOCK] = strip.GAP
        made.append(_image(pixels, "rgb8"))
    return [_world(), Stream("/image", IMAGE, 30, made, Lane(0, Place.PICTURE))]


def jpeg(width: int, height: int) -> list[Stream]:
    """JPEG at 30 Hz, each with a strip of its own."""
    made = []
    pixels = _picture(width, height, 0)
    for variant in range(VARIANTS):
        pixels[: strip.BLOCK, : strip.LENGTH * strip.BLOCK] = strip.pixels(0, variant)
        file = io.BytesIO()
        PIL.Image.fromarray(pixels).save(file, "JPEG", quality=90)
        data = np.frombuffer(file.getvalue(), np.uint8)
        kind = "rgb8; jpeg compressed bgr8"
        made.append({"header": header("optical"), "format": kind, "data": data})
    lane = Lane(0, Place.PICTURE, VARIANTS)
    return [_world(), Stream("/image/compressed", COMPRESSED, 30, made, lane)]


def depths(width: int, height: int) -> list[Stream]:
    """Depths of 16UC1 at 30 Hz; x of the point of the first pixel is the mark.

    Hence the principal point, left of the image: x is depth in mm by `PER_METRE`.
    """
    rng = np.random.default_rng(7)
    rows, columns = np.mgrid[:height, :width]
    walls = 2000 + 1000 * np.sin(columns / 90) + 500 * np.cos(rows / 70)
    left = -FOCAL * 1000 / PER_METRE
    lane = Lane(0, Place.FIRST_POINT, VARIANTS)
    made = []
    for variant in range(VARIANTS):
        millimetres = (walls + rng.normal(0, 5, walls.shape)).astype(np.uint16)
        millimetres[0, 0] = round(lane.encode(variant) * PER_METRE)
        made.append(_image(millimetres, "16UC1"))
    info = {
        "header": header("optical"),
        "width": width,
        "height": height,
        "distortion_model": "plumb_bob",
        "d": np.zeros(5),
        "k": np.array([FOCAL, 0, left, 0, FOCAL, height / 2, 0, 0, 1]),
        "r": np.eye(3).reshape(-1),
        "p": np.array([FOCAL, 0, left, 0, 0, FOCAL, height / 2, 0, 0, 0, 1, 0]),
    }
    return [
        _world(),
        Stream("/depth/camera_info", INFO, 30, [info]),
        Stream("/depth/image", IMAGE, 30, made, lane),
    ]


def _world() -> Stream:
    return Stream("/tf_static", TF, 0, static(("map", "optical")))


def _image(pixels: NDArray[Any], encoding: str) -> Values:
    height, width = pixels.shape[:2]
    return {
        "header": header("optical"),
        "height": height,
        "width": width,
        "encoding": encoding,
        "step": pixels.nbytes // height,
        "data": pixels.reshape(-1).view(np.uint8),
    }


def _picture(width: int, height: int, variant: int) -> NDArray[np.uint8]:
    """Smooth shades with some noise, as cameras have it: uint8 (H, W, 3)."""
    rng = np.random.default_rng(8)
    rows, columns = np.mgrid[:height, :width]
    phases = np.array([0.0, 2.0, 4.0]) + variant
    shades = np.sin(columns[..., None] / 120 + phases) + np.cos(rows[..., None] / 80 - phases)
    noisy = 128 + 50 * shades + rng.normal(0, 3, shades.shape)
    return np.clip(noisy, 0, 255).astype(np.uint8)
