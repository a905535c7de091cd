"""Compressed images and depth images, against Pillow and an encoder written for this test."""

from __future__ import annotations

import contextlib
import io
import struct
import zlib
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from webviz.data.images import (
    ImageError,
    decode_depth,
    inspect_compressed,
    open_compressed,
    read_png16,
)

DEPTHS = np.random.default_rng(4).integers(0, 4000, (48, 64)).astype(np.uint16)
DEPTHS[10:20] = 0
DEPTHS[30, ::3] = 0


def encoded(pixels: NDArray[np.uint8] | NDArray[np.uint16], format_: str) -> NDArray[np.uint8]:
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, format_)
    return np.frombuffer(file.getvalue(), np.uint8)


def rvl(depths: NDArray[np.uint16]) -> bytes:
    """Return the compressed image as in the paper, one number after the other."""
    nibbles: list[int] = []

    def put(number: int) -> None:
        while True:
            nibble, number = number & 7, number >> 3
            nibbles.append(nibble | (8 if number else 0))
            if not number:
                return

    flat, at, previous = [int(each) for each in depths.ravel()], 0, 0
    while at < len(flat):
        zeros = 0
        while at + zeros < len(flat) and flat[at + zeros] == 0:
            zeros += 1
        at += zeros
        run = 0
        while at + run < len(flat) and flat[at + run]:
            run += 1
        put(zeros)
        put(run)
        for value in flat[at : at + run]:
            delta = value - previous
            put((delta << 1) ^ (delta >> 31))
            previous = value
        at += run
    nibbles += [0] * (-len(nibbles) % 8)
    words = [
        sum(n << (28 - 4 * i) for i, n in enumerate(nibbles[k : k + 8]))
        for k in range(0, len(nibbles), 8)
    ]
    return struct.pack("<II", depths.shape[1], depths.shape[0]) + struct.pack(
        f"<{len(words)}I", *words
    )


def depth_message(payload: bytes, a: float = 0.0, b: float = 0.0) -> NDArray[np.uint8]:
    return np.frombuffer(struct.pack("<iff", 0, a, b) + payload, np.uint8)


def bomb(edge: int) -> bytes:
    """A small PNG that claims to be large."""
    head = b"IHDR" + struct.pack(">IIBBBBB", edge, edge, 8, 2, 0, 0, 0)
    chunk = struct.pack(">I", 13) + head + struct.pack(">I", zlib.crc32(head))
    return b"\x89PNG\r\n\x1a\n" + chunk + struct.pack(">I", 99) + b"IDAT" + bytes(9)


@pytest.mark.parametrize("format_", ["jpeg", "png", "webp"])
def test_the_type_of_an_image_is_read_from_its_data(format_: str) -> None:
    data = encoded(np.zeros((20, 30, 3), np.uint8), format_)
    for name in (format_, f"rgb8; {format_} compressed bgr8", "anything", ""):
        info = inspect_compressed(name, data)
        assert (info.mime, info.width, info.height) == (f"image/{format_}", 30, 20)
        assert not info.is_16_bit
        assert not info.swaps_red_and_blue


def test_the_first_picture_of_a_jpeg_sequence_is_used() -> None:
    first, second = (Image.new("RGB", (6, 4), color) for color in ("red", "blue"))
    file = io.BytesIO()
    first.save(file, "MPO", save_all=True, append_images=[second])
    info = inspect_compressed("jpeg", np.frombuffer(file.getvalue(), np.uint8))
    assert (info.mime, info.width, info.height) == ("image/jpeg", 6, 4)


@pytest.mark.parametrize("more", [{}, {"lossless": True}, {"exif": b"Exif\0\0"}])
def test_each_kind_of_webp_has_its_size(more: dict[str, Any]) -> None:
    file = io.BytesIO()
    Image.new("RGB", (300, 7), "red").save(file, "WEBP", **more)
    info = inspect_compressed("webp", np.frombuffer(file.getvalue(), np.uint8))
    assert (info.width, info.height) == (300, 7)


def test_odd_parts_of_a_png_do_not_matter() -> None:
    """Pillow warns about them, and warnings are errors in tests."""
    png = encoded(DEPTHS, "png").tobytes()
    odd = b"acTL" + struct.pack(">II", 0, 0)
    chunk = struct.pack(">I", 8) + odd + struct.pack(">I", zlib.crc32(odd))
    data = np.frombuffer(png[:33] + chunk + png[33:], np.uint8)
    assert inspect_compressed("png", data).is_16_bit
    np.testing.assert_array_equal(read_png16(data), DEPTHS)


def test_a_jpeg_is_not_decoded_at_another_size_than_it_has_in_front() -> None:
    jpeg = encoded(np.zeros((20, 30, 3), np.uint8), "jpeg").tobytes()
    at = jpeg.index(b"\xff\xc0")
    huge = jpeg[at : at + 5] + struct.pack(">HH", 60_000, 60_000) + jpeg[at + 9 : at + 19]
    data = np.frombuffer(jpeg[: at + 19] + huge + jpeg[at + 19 :], np.uint8)
    assert inspect_compressed("jpeg", data).width == 30
    with pytest.raises(ImageError, match="damaged"):
        open_compressed(data)


def test_the_format_string_gives_depth_and_colour_order() -> None:
    grey16 = encoded(DEPTHS, "png")
    assert inspect_compressed("16UC1; png compressed ", grey16).is_16_bit
    assert inspect_compressed("16UC1; png compressed ", grey16).encoding == "16UC1"
    jpeg = encoded(np.zeros((20, 30, 3), np.uint8), "jpeg")
    assert inspect_compressed("rgb8; jpeg compressed rgb8", jpeg).swaps_red_and_blue


@pytest.mark.parametrize(
    ("format_", "data", "sentence"),
    [
        ("jpeg", b"", "empty"),
        ("jpeg", b"\x00\x01\x02\x03abcdef", "begins with 00 01 02 03"),
        ("h264", b"\x00\x00\x00\x01abcdef", "h264 in CompressedImage is unsupported"),
        ("16UC1; compressedDepth png", b"\x00" * 40, "This is a depth image"),
        ("tiff", encoded(np.zeros((2, 2, 3), np.uint8), "tiff").tobytes(), "cannot show TIFF"),
        ("png", bomb(65535), "million"),
        ("png", bomb(0), "The PNG is damaged: its header has no size."),
        ("png", bomb(9)[:20], "The PNG is damaged"),
        ("jpeg", b"\xff\xd8" + b"\xff\xe0\0\2" * 10_000, "The JPEG is damaged"),
        ("jpeg", b"\xff\xd8" + b"\xff" * 100_000, "The JPEG is damaged"),
        ("webp", b"RIFF\0\0\0\0WEBPVP8X", "The WEBP is damaged"),
    ],
)  # fmt: skip
def test_formats_that_browsers_cannot_show_are_refused(
    format_: str, data: bytes, sentence: str
) -> None:
    with pytest.raises(ImageError) as error:
        inspect_compressed(format_, np.frombuffer(data, np.uint8))
    assert sentence in str(error.value)


@pytest.mark.parametrize("codec", ["png", "rvl"])
def test_depths_in_millimetres(codec: str) -> None:
    payload = rvl(DEPTHS) if codec == "rvl" else encoded(DEPTHS, "png").tobytes()
    encoding, depths = decode_depth(f"16UC1; compressedDepth {codec}", depth_message(payload))
    assert encoding == "16UC1"
    np.testing.assert_array_equal(depths, DEPTHS)


def test_old_publishers_name_no_codec() -> None:
    payload = encoded(DEPTHS, "png").tobytes()
    _, depths = decode_depth("16UC1; compressedDepth", depth_message(payload))
    np.testing.assert_array_equal(depths, DEPTHS)


@pytest.mark.parametrize("codec", ["png", "rvl"])
def test_inverse_depths_in_metres(codec: str) -> None:
    # The publisher's defaults, 100 steps and at most 10 m: 1 m is 10100 / (9091 + 1009).
    inverse = np.array([[9091, 0], [1, 65535]], np.uint16)
    payload = rvl(inverse) if codec == "rvl" else encoded(inverse, "png").tobytes()
    data = depth_message(payload, 10100.0, -1009.0)
    encoding, depths = decode_depth(f"32FC1; compressedDepth {codec}", data)
    assert encoding == "32FC1"
    assert depths[0, 0] == pytest.approx(1.0)
    assert np.isnan(depths[0, 1])
    assert depths[1, 0] == pytest.approx(10.0)
    assert depths[1, 1] == pytest.approx(10100 / 66544)


@pytest.mark.parametrize("claim", [(0, 0), (64, 0), (2**32 - 1, 2**32 - 1), (64, 4096)])
def test_an_rvl_stream_that_lies_about_its_size_is_named(claim: tuple[int, int]) -> None:
    data = depth_message(struct.pack("<II", *claim) + rvl(DEPTHS)[8:])
    with pytest.raises(ImageError, match="RVL"):
        decode_depth("16UC1; compressedDepth rvl", data)


def test_a_long_rvl_stream_of_single_pixels() -> None:
    runs = 240_000
    nibbles = np.tile(np.array([1, 1, 2], np.uint32), runs)  # a zero; one pixel, 1 more than before
    words = (nibbles.reshape(-1, 8) << np.arange(28, -1, -4).astype(np.uint32)).sum(1, dtype="<u4")
    data = depth_message(struct.pack("<II", 2 * runs, 1) + words.tobytes())
    _, depths = decode_depth("16UC1; compressedDepth rvl", data)
    expected = np.zeros((1, 2 * runs), np.uint16)
    expected[0, 1::2] = np.arange(1, runs + 1)
    np.testing.assert_array_equal(depths, expected)


def test_an_rvl_stream_of_empty_runs_is_refused_at_once() -> None:
    data = depth_message(struct.pack("<II", 640, 480) + bytes(100_000))
    with pytest.raises(ImageError, match="a run without a pixel"):
        decode_depth("16UC1; compressedDepth rvl", data)


def test_a_depth_png_that_claims_too_many_pixels_is_not_decompressed() -> None:
    with pytest.raises(ImageError, match="more than 67 million"):
        decode_depth("16UC1; compressedDepth png", depth_message(bomb(65535)))


def test_no_bytes_break_the_decoders() -> None:
    rng = np.random.default_rng(5)
    good = {
        "png": depth_message(encoded(DEPTHS, "png").tobytes()),
        "rvl": depth_message(rvl(DEPTHS)),
    }
    for codec, data in good.items():
        for _ in range(150):
            broken = data.copy()
            broken[rng.integers(0, len(data), 8)] = rng.integers(0, 256, 8)
            broken = broken[: rng.integers(0, len(data) + 1)]
            with contextlib.suppress(ImageError):
                decode_depth(f"16UC1; compressedDepth {codec}", broken)
