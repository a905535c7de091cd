"""What is inside sensor_msgs/CompressedImage, without decompressing it."""

from __future__ import annotations

import io
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from webviz.data.images.errors import ImageError
from webviz.data.images.raw import MAX_PIXELS

_MIME = {"JPEG": "image/jpeg", "PNG": "image/png", "WEBP": "image/webp"}
_STEREO = "MPO"
"""What Pillow calls a JPEG that more pictures follow, of which browsers show the first."""
_OTHERS = ("TIFF", "BMP", "GIF", "JPEG2000")
_VIDEO = ("h264", "h265", "hevc", "av1", "vp9", "vp8")


@dataclass(frozen=True)
class CompressedInfo:
    """What a compressed image says of itself.

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
    """What is inside a compressed image; its data decides, whatever `format_` says.

    Args:
        format_: "<encoding>; jpeg compressed <encoding of the pixels>", or just "jpeg".
        data: uint8 (N,).

    Raises:
        ImageError: no browser can show it.
    """
    encoding, _, rest = format_.partition(";")
    if not len(data):
        raise ImageError("The compressed image is empty: the publisher sends no data.")
    opened = _open(data, format_)
    kind = "JPEG" if opened.format == _STEREO else str(opened.format)
    mime = _MIME.get(kind)
    if mime is None:
        raise ImageError(
            f"Browsers cannot show {opened.format} images. Set the format of the publisher to jpeg "
            "or png."
        )
    return CompressedInfo(
        mime,
        opened.width,
        opened.height,
        is_16_bit=opened.mode.startswith("I"),
        # image_transport: what is compressed is BGR in the order of OpenCV, unless it says RGB.
        swaps_red_and_blue="compressed rgb" in rest,
        encoding=encoding.strip() if rest else "",
    )


def read_png16(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    """The values (H, W) of a PNG with 16 bits of grey.

    Raises:
        ImageError: it is broken.
    """
    opened = _open(data, "png")
    if opened.format != "PNG" or not opened.mode.startswith("I"):
        raise ImageError(f"Expected a PNG of 16-bit grey, got {opened.format} {opened.mode}.")
    try:
        return np.asarray(opened).astype(np.uint16)
    except (OSError, SyntaxError, ValueError) as error:
        raise ImageError(f"The PNG is broken: {str(error)[:80]}.") from error


def _open(data: NDArray[np.uint8], format_: str) -> Image.Image:
    """The header of an image; its pixels are not read yet."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # see below
            opened = Image.open(io.BytesIO(data.tobytes()), formats=(*_MIME, *_OTHERS))
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError, OverflowError) as error:
        start = bytes(data[:4]).hex(" ")
        raise ImageError(f"{_what(format_)}: its data begins with {start}.") from error
    except Image.DecompressionBombError as error:
        raise ImageError(
            f"The image has more than {MAX_PIXELS // 10**6} million pixels."
        ) from error
    if opened.width * opened.height > MAX_PIXELS:
        raise ImageError(
            f"{opened.width} x {opened.height} pixels are more than {MAX_PIXELS // 10**6} million."
        )
    return opened


def _what(format_: str) -> str:
    words = format_.lower()
    if "compresseddepth" in words:
        return "This is a depth image, but its header is missing"
    if video := next((each for each in _VIDEO if each in words), ""):
        return f"{video} in CompressedImage is unsupported; publish foxglove_msgs/CompressedVideo"
    return f"The data is not an image of format {format_[:40]!a}"
