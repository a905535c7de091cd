"""The encodings of sensor_msgs/Image: image_encodings.hpp of sensor_msgs 5 (Jazzy)."""

from __future__ import annotations

import difflib
import functools
import re
from typing import Literal

import msgspec
import numpy as np

from webviz.data.images.errors import ImageError

Order = Literal["plain", "rgb", "bgr", "bayer", "uyvy", "yuyv", "nv21", "nv24"]


class PixelLayout(msgspec.Struct, frozen=True):
    """Layout of the pixels of an encoding in the bytes of an image.

    Args:
        dtype: of one number, in the byte order of this machine.
        channels: numbers per pixel, of a row of the first plane.
        order: of the channels; "plain" is one number or several without a meaning.
        pattern: of a Bayer mosaic: colours of the first two pixels of the first two rows, "rggb".
        is_scaled: whether the numbers are measurements, to be scaled to what a screen can show.
        zero_is_invalid: whether 0 stands for no measurement (REP 118: depth in mm).
        unit: "m" or "mm" of depth images by REP 118, else "".
    """

    dtype: np.dtype[np.generic]
    channels: int
    order: Order
    pattern: str = ""
    is_scaled: bool = False
    zero_is_invalid: bool = False
    unit: str = ""

    @property
    def pixel_bytes(self) -> int:
        """Bytes of one pixel in a row of the first plane."""
        return self.dtype.itemsize * self.channels

    @property
    def work_bytes(self) -> int:
        """Bytes that a pixel takes on its way to a screen, besides the message: measured."""
        if self.is_scaled:
            return 14 * self.channels
        return 8 if self.dtype.itemsize == 1 else 16


def _color(depth: int, channels: int, order: Order) -> PixelLayout:
    return PixelLayout(np.dtype(f"u{depth // 8}"), channels, order)


_U8, _U16 = np.dtype(np.uint8), np.dtype(np.uint16)
_NAMED = {
    **{
        f"{order}{alpha}{depth}": _color(depth, 3 + len(alpha), order)
        for order in ("rgb", "bgr")
        for alpha in ("", "a")
        for depth in (8, 16)
    },
    "mono8": PixelLayout(_U8, 1, "plain"),
    "mono16": PixelLayout(_U16, 1, "plain", is_scaled=True),
    **{
        f"bayer_{pattern}{depth}": PixelLayout(np.dtype(f"u{depth // 8}"), 1, "bayer", pattern)
        for pattern in ("rggb", "bggr", "gbrg", "grbg")
        for depth in (8, 16)
    },
    "uyvy": PixelLayout(_U8, 2, "uyvy"),
    "yuv422": PixelLayout(_U8, 2, "uyvy"),
    "yuyv": PixelLayout(_U8, 2, "yuyv"),
    "yuv422_yuy2": PixelLayout(_U8, 2, "yuyv"),
    "nv21": PixelLayout(_U8, 1, "nv21"),
    "nv24": PixelLayout(_U8, 1, "nv24"),
}
_MATRIX = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)C([1-4]?)")
_KINDS = {"U": "u", "S": "i", "F": "f"}
_CHANNELS: tuple[Order, ...] = ("plain", "plain", "bgr", "bgr")
"""Order of the channels of OpenCV's matrices by their number; three are BGR as everywhere there."""

ENCODINGS = (
    *_NAMED,
    *(
        f"{depth}C{channels}"
        for depth in ("8U", "8S", "16U", "16S", "32S", "32F", "64F")
        for channels in (1, 2, 3, 4)
    ),
)
"""All encodings that can be shown."""


@functools.cache
def layout_of(encoding: str) -> PixelLayout:
    """Return the layout of an encoding.

    Raises:
        ImageError: the encoding is unknown.
    """
    if (layout := _NAMED.get(encoding)) is not None:
        return layout
    if (matrix := _MATRIX.fullmatch(encoding)) is None:
        raise ImageError(_unknown(encoding))
    depth, channels = matrix[1], int(matrix[2] or 1)
    dtype = np.dtype(f"{_KINDS[depth[-1]]}{int(depth[:-1]) // 8}")
    order = _CHANNELS[channels - 1]
    if depth == "8U" and channels != 2:
        return PixelLayout(dtype, channels, order)
    name = f"{depth}C{channels}"
    is_millimetres = name == "16UC1"
    unit = {"16UC1": "mm", "32FC1": "m"}.get(name, "")
    return PixelLayout(
        dtype, channels, order, is_scaled=True, zero_is_invalid=is_millimetres, unit=unit
    )


def _unknown(encoding: str) -> str:
    short = ascii(encoding[:40])
    if not encoding:
        return "The image names no encoding. Set it in the publisher, such as rgb8."
    near = difflib.get_close_matches(encoding[:40], ENCODINGS, 1)
    hint = f"did you mean {near[0]}?" if near else "publish rgb8, mono8 or 32FC1, for example."
    return f"Unsupported encoding {short}: {hint}"
