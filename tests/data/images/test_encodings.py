"""Every encoding of sensor_msgs, against Pillow and against pixels worked out by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image

from webviz.data.images import (
    ENCODINGS,
    ImageError,
    RawImage,
    Tone,
    layout_of,
    raw,
    remarks,
    to_rgb,
    tone,
    value_range,
    values,
)


def message(
    encoding: str, data: Any, width: int, height: int, step: int = 0, is_big: bool = False
) -> Any:
    raw = np.frombuffer(np.ascontiguousarray(data).tobytes(), np.uint8)
    return SimpleNamespace(
        encoding=encoding, width=width, height=height, step=step or len(raw) // height, data=raw,
        is_bigendian=is_big,
    )  # fmt: skip


GREY = Tone()


def rgb_of(encoding: str, data: Any, width: int, height: int, tone: Tone = GREY) -> Any:
    image = RawImage.of(message(encoding, data, width, height))
    return to_rgb(values(image), image.layout, tone)


NOISE = np.random.default_rng(1).integers(0, 256, (6, 8, 3), np.uint8)


@pytest.mark.parametrize(
    ("encoding", "order"), [("rgb8", "RGB"), ("bgr8", "BGR"), ("8UC3", "BGR"), ("rgba8", "RGBA"),
                            ("bgra8", "BGRA"), ("8UC4", "BGRA")],
)  # fmt: skip
def test_colors_are_those_that_pillow_reads(encoding: str, order: str) -> None:
    wide = np.concatenate((NOISE, np.zeros((6, 8, len(order) - 3), np.uint8)), axis=2)
    mode = "RGBA" if len(order) == 4 else "RGB"
    expected = Image.frombytes(mode, (8, 6), wide.tobytes(), "raw", order).convert("RGB")
    np.testing.assert_array_equal(rgb_of(encoding, wide, 8, 6), np.asarray(expected))


@pytest.mark.parametrize("encoding", ["rgb16", "rgba16", "bgr16", "bgra16"])
def test_colors_of_16_bits_keep_their_upper_byte(encoding: str) -> None:
    pixel = [0x1234, 0x5678, 0x9ABC, 0xFFFF][: 4 if "a" in encoding else 3]
    rgb = (0x12, 0x56, 0x9A) if encoding.startswith("rgb") else (0x9A, 0x56, 0x12)
    assert tuple(rgb_of(encoding, np.array([pixel], "<u2"), 1, 1)[0, 0]) == rgb


@pytest.mark.parametrize(("encoding", "places"), [
    ("uyvy", "u0 y0 v0 y1"), ("yuv422", "u0 y0 v0 y1"),
    ("yuyv", "y0 u0 y1 v0"), ("yuv422_yuy2", "y0 u0 y1 v0"),
])  # fmt: skip
def test_pairs_that_share_their_colors(encoding: str, places: str) -> None:
    parts = {"y0": 180, "y1": 60, "u0": 90, "v0": 200}
    data = np.array([parts[name] for name in places.split()], np.uint8)
    yuv = np.array([[[180, 90, 200], [60, 90, 200]]], np.uint8)
    expected = np.asarray(Image.fromarray(yuv, "YCbCr").convert("RGB")).astype(int)
    assert np.abs(rgb_of(encoding, data, 2, 1).astype(int) - expected).max() <= 1


@pytest.mark.parametrize(("encoding", "u", "v"), [("nv21", 1, 0), ("nv24", 0, 1)])
@pytest.mark.parametrize(("width", "height"), [(4, 4), (5, 3), (1, 1)])
def test_planes_of_brightness_and_colors(
    encoding: str, u: int, v: int, width: int, height: int
) -> None:
    rng = np.random.default_rng(2)
    step = width + width % 2
    luma = rng.integers(0, 256, (height, step), np.uint8)
    shape = ((height + 1) // 2, step // 2) if encoding == "nv21" else (height, step)
    pairs = rng.integers(0, 256, (*shape, 2), np.uint8)
    data = np.concatenate((luma.ravel(), pairs.ravel()))
    every = 2 if encoding == "nv21" else 1
    yuv = np.empty((height, width, 3), np.uint8)
    for row in range(height):
        for column in range(width):
            pair = pairs[row // every, column // every]
            yuv[row, column] = luma[row, column], pair[u], pair[v]
    image = RawImage.of(message(encoding, data, width, height, step))
    expected = np.asarray(Image.fromarray(yuv, "YCbCr").convert("RGB")).astype(int)
    assert np.abs(values(image).astype(int) - expected).max() <= 1


@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
@pytest.mark.parametrize(("depth", "scale"), [("8", 1), ("16", 256)])
def test_a_mosaic_of_one_color_is_that_color(pattern: str, depth: str, scale: int) -> None:
    color = {"r": 200, "g": 100, "b": 50}
    tile = np.array([color[c] for c in pattern]).reshape(2, 2) * scale
    data = np.tile(tile, (3, 4)).astype(f"<u{int(depth) // 8}")
    rgb = rgb_of(f"bayer_{pattern}{depth}", data, 8, 6)
    assert (rgb == (200, 100, 50)).all()


def test_a_mosaic_is_interpolated_between_its_neighbours() -> None:
    # rggb; a red pixel in the middle of the third row and column
    data = np.array([[10, 1, 20, 1], [2, 30, 4, 50], [60, 3, 40, 5], [6, 70, 8, 90]], np.uint8)
    rgb = rgb_of("bayer_rggb8", data, 4, 4)
    assert tuple(rgb[2, 2]) == (40, (4 + 8 + 3 + 5) / 4, (30 + 50 + 70 + 90) / 4)
    assert tuple(rgb[1, 1]) == ((10 + 20 + 60 + 40 + 2) // 4, (1 + 3 + 2 + 4 + 2) // 4, 30)
    assert tuple(rgb[1, 2]) == ((20 + 40) / 2, 4, (30 + 50) / 2)


@pytest.mark.parametrize("encoding", ["bayer_grbg8", "bayer_bggr16", "uyvy", "nv21", "nv24"])
def test_an_image_has_no_seams_though_it_is_read_in_strips(
    encoding: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    layout, width, height = layout_of(encoding), 6, 11
    step = width * layout.pixel_bytes
    rows = {"nv21": height + (height + 1) // 2, "nv24": 3 * height}.get(layout.order, height)
    data = np.random.default_rng(4).integers(0, 256, rows * step, np.uint8)
    image = RawImage.of(message(encoding, data, width, height, step))
    whole = values(image)
    monkeypatch.setattr(raw, "_STRIP_ROWS", 2)
    np.testing.assert_array_equal(values(image), whole)


def test_a_range_is_that_of_all_strips(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tone, "_STRIP_ROWS", 2)
    depths = np.array([[0, 3], [0, 0], [0, 0], [0, 0], [9, 5]], np.uint16)
    assert value_range(depths, zero_is_invalid=True) == (3.0, 9.0)
    assert value_range(depths[1:4], zero_is_invalid=True) is None


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize(("width", "height"), [(1, 1), (3, 2), (7, 5)])
def test_every_encoding_has_pixels(encoding: str, width: int, height: int) -> None:
    layout = layout_of(encoding)
    step = width * layout.pixel_bytes + 3  # a gap that no number fits in
    rows = {"nv21": height + (height + 1) // 2, "nv24": 3 * height}.get(layout.order, height)
    data = np.random.default_rng(3).integers(0, 256, rows * step, np.uint8)
    image = RawImage.of(message(encoding, data, width, height, step))
    pixels = to_rgb(values(image), layout, Tone(0.0, 200.0, "Turbo"))
    assert pixels.dtype == np.uint8
    assert pixels.shape[:2] == (height, width)
    assert pixels.shape[2:] in ((), (3,))


@pytest.mark.parametrize(
    ("encoding", "dtype"),
    [("16UC1", "u2"), ("mono16", "u2"), ("16SC1", "i2"), ("32SC1", "i4"), ("32FC1", "f4"),
     ("64FC1", "f8")],
)  # fmt: skip
@pytest.mark.parametrize("is_big", [False, True])
def test_numbers_have_the_byte_order_of_the_message(
    encoding: str, dtype: str, is_big: bool
) -> None:
    numbers = np.array([[1, 300], [7, 5000]], (">" if is_big else "<") + dtype)
    image = RawImage.of(message(encoding, numbers, 2, 2, is_big=is_big))
    np.testing.assert_array_equal(values(image), [[1, 300], [7, 5000]])


def test_depths_below_one_metre_use_all_of_the_range() -> None:
    depths = np.array([[0.2, 0.4], [np.nan, 0.6]], np.float32)
    limits = value_range(depths, zero_is_invalid=False)
    assert limits == pytest.approx((0.2, 0.6))
    grey = rgb_of("32FC1", depths, 2, 2, Tone(*limits or (0, 0)))
    np.testing.assert_array_equal(grey, [[0, 127], [0, 255]])


def test_a_depth_of_0_mm_is_invalid() -> None:
    depths = np.array([[0, 500], [1000, 1500]], np.uint16)
    assert value_range(depths, zero_is_invalid=True) == (500, 1500)
    colors = rgb_of("16UC1", depths, 2, 2, Tone(500, 1500, "Viridis"))
    assert tuple(colors[0, 0]) == (0, 0, 0)
    assert tuple(colors[0, 1]) == (0x44, 0x01, 0x54)
    assert tuple(colors[1, 1]) == (0xFD, 0xE7, 0x25)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_picture_without_a_number_has_no_range(bad: float) -> None:
    depths = np.full((2, 2), bad, np.float32)
    assert value_range(depths, zero_is_invalid=False) is None
    assert not rgb_of("32FC1", depths, 2, 2).any()


@pytest.mark.parametrize(("low", "high"), [(-1e308, 1e308), (0.0, 1e-310), (1e300, 1e301), (5, 5)])
def test_extreme_ranges_have_pixels(low: float, high: float) -> None:
    data = np.array([[low, high, 0.0, np.inf, 1e308]])
    grey = rgb_of("64FC1", data, 5, 1, Tone(low, high))
    assert grey[0, 3] == 0
    assert grey[0, 1] >= grey[0, 0]


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"encoding": "rgb9"}, "Unsupported encoding 'rgb9': did you mean rgb8?"),
        ({"encoding": ""}, "The image names no encoding"),
        ({"encoding": "\x1b[31mx" * 99}, "Unsupported encoding"),
        ({"width": 0}, "0 x 2 pixels"),
        ({"width": 2**32 - 1, "height": 2**32 - 1}, "are more than"),
        ({"step": 5}, "step is 5 bytes, but 2 pixels of rgb8 take 6"),
        ({"height": 3}, "data has 12 bytes, but 2 x 3 pixels of rgb8 with a step of 6 take 18"),
        ({"step": 2**32 - 1}, "data has 12 bytes"),
    ],
)
def test_inconsistent_images_are_refused(changes: dict[str, Any], sentence: str) -> None:
    whole = message("rgb8", np.zeros(12, np.uint8), 2, 2)
    with pytest.raises(ImageError, match=r"^[ -~]*$") as error:
        RawImage.of(SimpleNamespace(**(vars(whole) | changes)))
    assert sentence in str(error.value)


def test_suspicious_images_are_shown_with_a_remark() -> None:
    without_step = SimpleNamespace(
        **(vars(message("rgb8", np.zeros(12, np.uint8), 2, 2)) | {"step": 0})
    )
    assert "step is 0 instead of 6" in remarks(without_step, RawImage.of(without_step))
    too_long = message("mono8", np.zeros(12, np.uint8), 2, 2, step=2)
    assert "8 more than 2 x 2 pixels of mono8 take" in remarks(too_long, RawImage.of(too_long))
