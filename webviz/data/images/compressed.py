"""Content of sensor_msgs/CompressedImage, without decompressing it."""

from __future__ import annotations

import contextlib
import io
import struct
from collections.abc import Iterator

import msgspec
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from webviz.data.images.errors import ImageError
from webviz.data.images.headers import PNG, ImageHeader, read_header
from webviz.data.images.raw import MAX_PIXELS
from webviz.data.memory import DECODING, OverBudgetError

_MIME = {"JPEG": "image/jpeg", "PNG": "image/png", "WEBP": "image/webp"}
_VIDEO = ("h264", "h265", "hevc", "av1", "vp9", "vp8")
_CRITICAL = (b"IHDR", b"IDAT", b"IEND")
_MAX_CHUNKS = 100_000
_PNG16_BYTES = 6
"""Bytes per pixel, measured."""


class CompressedInfo(msgspec.Struct, frozen=True):
    """Declared content of a compressed image.

    Args:
        mime: for browsers, such as "image/jpeg".
        width, height: in pixels.
        is_16_bit: a PNG with 16 bits of grey, of which browsers would show 8.
        swaps_red_and_blue: the publisher encoded RGB as if it were BGR.
        encoding: of the image before compression, "" if it is not named.
    """

    mime: str
    width: int
    height: int
    is_16_bit: bool
    swaps_red_and_blue: bool
    encoding: str


def inspect_compressed(format_: str, data: NDArray[np.uint8]) -> CompressedInfo:
    """Return the content of a compressed image; its data decides, not `format_`.

    Args:
        format_: "<encoding>; jpeg compressed <encoding of the pixels>", or just "jpeg".
        data: uint8 (N,).

    Raises:
        ImageError: no browser can show it.
    """
    encoding, _, rest = format_.partition(";")
    if not len(data):
        raise ImageError("The compressed image is empty: the publisher sends no data.")
    header = _header(data, format_)
    mime = _MIME.get(header.kind)
    if mime is None:
        raise ImageError(
            f"Browsers cannot show {header.kind} images. Set the format of the publisher to jpeg "
            "or png."
        )
    return CompressedInfo(
        mime,
        header.width,
        header.height,
        is_16_bit=header.is_16_bit,
        # image_transport: what is compressed is BGR in the order of OpenCV, unless it says RGB.
        swaps_red_and_blue="compressed rgb" in rest,
        encoding=encoding.strip() if rest else "",
    )


def read_png16(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    """Return the values (H, W) of a PNG with 16 bits of grey.

    Raises:
        ImageError: it is broken.
    """
    header = _header(data, "png")
    if not header.is_16_bit:
        raise ImageError(f"Expected a PNG of 16-bit grey, got another {header.kind}.")
    with decoding(header.width, header.height, _PNG16_BYTES):
        return _pixels_of(data)


def _pixels_of(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    try:
        # Without the chunks that Pillow warns about.
        plain = PNG + b"".join(_chunks(np.ascontiguousarray(data).data))
        with Image.open(io.BytesIO(plain), formats=("PNG",)) as opened:
            return np.asarray(opened).astype(np.uint16)
    except (OSError, SyntaxError, ValueError, struct.error) as error:
        raise ImageError(f"The PNG is broken: {str(error)[:80]}.") from error


@contextlib.contextmanager
def decoding(width: int, height: int, pixel_bytes: int) -> Iterator[None]:
    """Hold the memory that decoding an image takes, after waiting for that of others.

    Args:
        width, height: that its header claims.
        pixel_bytes: that each pixel takes on its way, copies included.

    Raises:
        ImageError: there is not so much.
    """
    try:
        with DECODING.take(width * height * pixel_bytes):
            yield
    except OverBudgetError as error:
        text = f"The image of {width} x {height} pixels {error}. Publish a smaller one."
        raise ImageError(text) from None


def open_compressed(data: NDArray[np.uint8]) -> Image.Image:
    """Return a JPEG, PNG or WebP as Pillow's; its pixels are not read yet.

    Raises:
        ImageError: it is none, or damaged, or larger than its header says.
    """
    size = _header(data, "").size
    try:
        opened = Image.open(io.BytesIO(data.tobytes()), formats=tuple(_MIME))
    except (OSError, SyntaxError, ValueError, Warning, Image.DecompressionBombError) as error:
        raise ImageError(f"The image is damaged: {str(error)[:80]}.") from error
    if opened.size != size:  # a JPEG may have several
        raise ImageError(f"The image is damaged: its header says {size[0]} x {size[1]} pixels.")
    return opened


def _chunks(data: memoryview) -> Iterator[memoryview]:
    """Yield the parts of a PNG that its pixels depend on."""
    at = len(PNG)
    for _ in range(_MAX_CHUNKS):
        if at >= len(data):
            return
        length, name = struct.unpack_from(">I4s", data, at)
        end = at + 12 + length
        if name in _CRITICAL:
            yield data[at:end]
        at = end
    raise ValueError(f"it has more than {_MAX_CHUNKS} parts")


def _header(data: NDArray[np.uint8], format_: str) -> ImageHeader:
    """Return the header of an image that is not too large."""
    header = read_header(np.ascontiguousarray(data).data)
    if header is None:
        start = bytes(data[:4]).hex(" ")
        raise ImageError(f"{_what(format_)}: its data begins with {start}.")
    if header.width * header.height > MAX_PIXELS:
        raise ImageError(
            f"{header.width} x {header.height} pixels are more than {MAX_PIXELS // 10**6} million."
        )
    return header


def _what(format_: str) -> str:
    words = format_.lower()
    if "compresseddepth" in words:
        return "This is a depth image, but its header is missing"
    if video := next((each for each in _VIDEO if each in words), ""):
        return f"{video} in CompressedImage is unsupported; publish foxglove_msgs/CompressedVideo"
    return f"The data is not an image of format {format_[:40]!a}"
