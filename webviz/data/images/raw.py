"""Pixels of uncompressed images."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.images.encodings import PixelLayout, layout_of
from webviz.data.images.errors import ImageError
from webviz.data.memory import DECODING

U8 = NDArray[np.uint8]


def packed_to_rgb(pixels: U8, is_color_first: bool) -> U8:
    """Pixels that share their colours in pairs, such as UYVY.

    Args:
        pixels: (H, W, 2), brightness and half of a colour.
        is_color_first: UYVY, else YUYV.

    Returns:
        RGB (H, W, 3).
    """
    luma, chroma = (1, 0) if is_color_first else (0, 1)
    width = pixels.shape[1]
    # Of an odd width the last pixel has no V: it takes that of its neighbour.
    u = np.repeat(pixels[:, 0::2, chroma], 2, axis=1)[:, :width]
    odd = pixels[:, 1::2, chroma]
    v = np.repeat(odd if width > 1 else pixels[:, :1, chroma], 2, axis=1)
    v = np.pad(v, ((0, 0), (0, max(0, width - v.shape[1]))), "edge")[:, :width]
    return _rgb(pixels[..., luma], u, v)


def planes_to_rgb(luma: U8, chroma: U8, step: int, is_nv21: bool) -> U8:
    """Return a plane of brightness, and one of colours.

    Args:
        luma: (H, W).
        chroma: uint8 (N,): pairs of V, U for 2 x 2 pixels (NV21), or of U, V for each (NV24).
        step: bytes from one row of `luma` to the next.
        is_nv21: NV21, else NV24.

    Returns:
        RGB (H, W, 3).
    """
    height, width = luma.shape
    rows, columns, pitch = height, width, 2 * step
    if is_nv21:
        rows, columns, pitch = (height + 1) // 2, (width + 1) // 2, step
    # The last pair of an odd width may be cut off by the step.
    whole = np.zeros((rows, max(pitch, 2 * columns)), np.uint8)
    whole[:, :pitch] = chroma[: rows * pitch].reshape(rows, pitch)
    pairs = whole[:, : 2 * columns].reshape(rows, columns, 2)
    if is_nv21:
        pairs = np.repeat(np.repeat(pairs, 2, axis=0), 2, axis=1)[:height, :width]
    u, v = (1, 0) if is_nv21 else (0, 1)
    return _rgb(luma, pairs[..., u], pairs[..., v])


def _rgb(y: U8, u: U8, v: U8) -> U8:
    """Convert by the full-range matrix of BT.601, as in JPEG files (ITU-T T.871, section 7)."""
    blue, red = u.astype(np.float32) - 128.0, v.astype(np.float32) - 128.0
    bright = y.astype(np.float32)
    rgb = np.empty((*y.shape, 3), np.float32)
    rgb[..., 0] = bright + 1.402 * red
    rgb[..., 1] = bright - 0.344136 * blue - 0.714136 * red
    rgb[..., 2] = bright + 1.772 * blue
    rgb += 0.5
    return np.clip(rgb, 0.0, 255.0, out=rgb).astype(np.uint8)


MAX_PIXELS = 1 << 26
"""8192 x 8192: what browsers can show."""

_STRIP_ROWS = 128
"""Even, as colours are shared by two rows."""

_NATIVE_BIG = np.dtype(np.uint16).newbyteorder("=") == np.dtype(">u2")


class RawImage(msgspec.Struct, frozen=True, eq=False, weakref=True):
    """An image as in sensor_msgs/Image, checked: its bytes hold what its fields say.

    Args:
        width, height: in pixels.
        encoding: one of `ENCODINGS`.
        step: bytes from one row to the next.
        is_bigendian: byte order of numbers of several bytes.
        data: uint8 (N,).
    """

    width: int
    height: int
    encoding: str
    step: int
    is_bigendian: bool
    data: NDArray[np.uint8]

    @staticmethod
    def of(message: Any) -> RawImage:
        """Return the image of a sensor_msgs/Image.

        A step of 0 counts as rows without a gap.

        Raises:
            ImageError: the fields contradict each other or the data.
        """
        layout = layout_of(message.encoding)
        width, height = int(message.width), int(message.height)
        if not width or not height:
            raise ImageError(
                f"The image is {width} x {height} pixels: the publisher sends an empty image."
            )
        if width * height > MAX_PIXELS:
            raise ImageError(
                f"{width} x {height} pixels are more than {MAX_PIXELS // 10**6} million."
            )
        if width * height * layout.work_bytes > DECODING.least_room:
            most = DECODING.least_room // layout.work_bytes
            raise ImageError(
                f"{width} x {height} pixels of {message.encoding} need more memory than there is. "
                f"Publish at most {most // 10**6} million."
            )
        row = width * layout.pixel_bytes
        step = int(message.step) or row
        if step < row:
            raise ImageError(
                f"step is {step} bytes, but {width} pixels of {message.encoding} take {row}. "
                "Correct the width, encoding or step in the publisher."
            )
        data = np.asarray(message.data, np.uint8)
        needed = needed_bytes(layout, width, height, step)
        if len(data) < needed:
            raise ImageError(
                f"data has {len(data)} bytes, but {width} x {height} pixels of "
                f"{message.encoding} with a step of {step} take {needed}. "
                "Correct the size, encoding or step in the publisher."
            )
        return RawImage(width, height, message.encoding, step, bool(message.is_bigendian), data)

    @staticmethod
    def from_values(encoding: str, pixels: NDArray[Any]) -> RawImage:
        """Return an image of numbers (H, W) of an encoding with one channel."""
        height, width = pixels.shape
        data = np.ascontiguousarray(pixels).view(np.uint8).reshape(-1)
        step = width * pixels.itemsize
        return RawImage(width, height, encoding, step, _NATIVE_BIG, data)

    @property
    def layout(self) -> PixelLayout:
        """Layout of the encoding's pixels."""
        return layout_of(self.encoding)


def remarks(message: Any, image: RawImage) -> str:
    """Return a sentence on suspicious fields of a drawable message; "" if there are none."""
    if not message.step:
        return f"step is 0 instead of {image.step}; rows are assumed to follow without a gap."
    size = whole_bytes(image.layout, image.height, image.step)
    if len(image.data) > size:
        return (
            f"data has {len(image.data)} bytes, {len(image.data) - size} more than {image.width} x "
            f"{image.height} pixels of {image.encoding} take. Check the encoding in the publisher."
        )
    return ""


def values(image: RawImage) -> NDArray[Any]:
    """Return the pixels of an image.

    Returns:
        (H, W) of one channel, (H, W, 2) of two, else RGB (H, W, 3) without alpha. Numbers are those
        of the message; YUV becomes RGB, and Bayer mosaics are interpolated. It may be a view.
    """
    layout, height, width = image.layout, image.height, image.width
    if layout.order in ("nv21", "nv24"):
        first = np.lib.stride_tricks.as_strided(
            image.data, (height, width), (image.step, 1), writeable=False
        )
        rest = image.data[height * image.step :]
        is_nv21 = layout.order == "nv21"
        colors = image.step // 2 if is_nv21 else 2 * image.step
        return _in_strips(
            first.shape,
            lambda a, b: planes_to_rgb(first[a:b], rest[a * colors :], image.step, is_nv21),
        )
    pixels = _grid(image, layout)
    match layout.order:
        case "uyvy" | "yuyv":
            is_color_first = layout.order == "uyvy"
            return _in_strips(
                (height, width), lambda a, b: packed_to_rgb(pixels[a:b], is_color_first)
            )
        case "bayer":
            mosaic = pixels[..., 0]
            return _in_strips((height, width), lambda a, b: _colors(mosaic, layout.pattern, a, b))
        case "rgb":
            return pixels[..., :3]
        case "bgr":
            return pixels[..., 2::-1]
    return pixels[..., 0] if layout.channels == 1 else pixels


def _in_strips(shape: tuple[int, ...], make: Callable[[int, int], NDArray[Any]]) -> NDArray[Any]:
    """RGB (H, W, 3) made of a few rows at once, since that takes ten times its memory.

    Args:
        shape: (H, W).
        make: the pixels from one row to another.
    """
    height, width = shape
    first = make(0, min(_STRIP_ROWS, height))
    rgb = np.empty((height, width, 3), first.dtype)
    rgb[: len(first)] = first
    for start in range(_STRIP_ROWS, height, _STRIP_ROWS):
        stop = min(start + _STRIP_ROWS, height)
        rgb[start:stop] = make(start, stop)
    return rgb


def _colors(mosaic: NDArray[Any], pattern: str, start: int, stop: int) -> NDArray[Any]:
    """Return some rows of a mosaic; `start` is even, as the pattern repeats every two rows."""
    begin = max(0, start - 2)  # colours depend on neighbours
    return demosaic(mosaic[begin : stop + 2], pattern)[start - begin : stop - begin]


def _grid(image: RawImage, layout: PixelLayout) -> NDArray[Any]:
    """Return the numbers of an image, (H, W, channels), in the byte order of this machine."""
    size = layout.dtype.itemsize
    row = image.width * layout.pixel_bytes
    data = np.ascontiguousarray(image.data)
    rows = np.lib.stride_tricks.as_strided(
        data, (image.height, row), (image.step, 1), writeable=False
    )
    if size > 1 and (image.step % size or data.ctypes.data % size):
        rows = np.ascontiguousarray(rows)
    numbers = rows.view(layout.dtype)
    if size > 1 and image.is_bigendian != _NATIVE_BIG:
        numbers = numbers.byteswap()
    return numbers.reshape(image.height, image.width, layout.channels)


def needed_bytes(layout: PixelLayout, width: int, height: int, step: int) -> int:
    """Return the bytes that an image has at least; the gap behind the last row may be missing."""
    last_gap = step - width * layout.pixel_bytes
    return whole_bytes(layout, height, step) - (0 if layout.order.startswith("nv") else last_gap)


def whole_bytes(layout: PixelLayout, height: int, step: int) -> int:
    """Return the bytes of an image whose rows have `step` bytes each."""
    match layout.order:
        case "nv21":  # a colour for each 2 x 2 pixels
            return step * (height + (height + 1) // 2)
        case "nv24":  # a colour for each pixel
            return step * height * 3
    return step * height


def demosaic(mosaic: NDArray[Any], pattern: str) -> NDArray[Any]:
    """Return the colours of a mosaic: missing ones are means of their two or four neighbours.

    Args:
        mosaic: unsigned integers (H, W).
        pattern: colours of the first two pixels of the first two rows, such as "rggb".

    Returns:
        RGB (H, W, 3) of the same type.
    """
    height, width = mosaic.shape
    # Mirrored at the border pixel, so that a neighbour keeps its colour.
    before, after = (int(height > 1), int(width > 1))
    padded = np.pad(mosaic, ((before, before), (after, after)), "reflect")
    padded = np.pad(padded, ((1 - before, 1 - before), (1 - after, 1 - after)), "edge")
    wide = padded.astype(np.uint32)
    centre = wide[1:-1, 1:-1]
    beside = (wide[1:-1, :-2] + wide[1:-1, 2:] + 1) // 2
    above = (wide[:-2, 1:-1] + wide[2:, 1:-1] + 1) // 2
    cross = (wide[1:-1, :-2] + wide[1:-1, 2:] + wide[:-2, 1:-1] + wide[2:, 1:-1] + 2) // 4
    corners = (wide[:-2, :-2] + wide[:-2, 2:] + wide[2:, :-2] + wide[2:, 2:] + 2) // 4
    rgb = np.empty((height, width, 3), mosaic.dtype)
    for cell, color in enumerate(pattern):
        at = np.s_[cell // 2 :: 2, cell % 2 :: 2]
        if color == "g":
            is_red_row = "r" in pattern[cell // 2 * 2 : cell // 2 * 2 + 2]
            rgb[at][..., 0] = (beside if is_red_row else above)[at]
            rgb[at][..., 1] = centre[at]
            rgb[at][..., 2] = (above if is_red_row else beside)[at]
        else:
            own, other = (0, 2) if color == "r" else (2, 0)
            rgb[at][..., own] = centre[at]
            rgb[at][..., 1] = cross[at]
            rgb[at][..., other] = corners[at]
    return rgb
