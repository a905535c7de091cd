"""Images and matrices as RTAB-Map compresses them."""

from __future__ import annotations

import zlib

import numpy as np
from numpy.typing import NDArray

from webviz.api.decoded import PIXEL_BYTES, opened
from webviz.api.pictures import Encoded
from webviz.data.images import ImageError, decoding, inspect_compressed, open_compressed
from webviz.data.images.compressed import read_png16
from webviz.data.images.rvl import decode_rvl

U8 = NDArray[np.uint8]
F32 = NDArray[np.float32]

RVL = b"DEPTHRVL"
"""Bytes in front of depths that are compressed by RVL."""
TRAILER = 12
"""Bytes behind a compressed matrix: its rows, columns and OpenCV's type as int32."""
FLOATS = 5
"""OpenCV's depth of float32, the lower three bits of a type."""
MAX_FLOATS = 16_000_000


def depths_of(data: U8) -> F32:
    """Return the depths (H, W) of an image in metres; 0 where nothing was measured.

    Args:
        data: a PNG of 16 bits in millimetres, RVL of the same, or a PNG whose four channels are the
            bytes of float32 in metres.

    Raises:
        ImageError: it is none of them.
    """
    if data[: len(RVL)].tobytes() == RVL:
        return decode_rvl(data[len(RVL) :]) * np.float32(0.001)
    if inspect_compressed("png", data).is_16_bit:
        return read_png16(data) * np.float32(0.001)
    with open_compressed(data) as image, decoding(*image.size, PIXEL_BYTES):
        if image.mode != "RGBA":
            raise ImageError(f"Expected depths, got an image of the mode {image.mode}.")
        try:
            rgba = np.asarray(image)
        except (OSError, SyntaxError, ValueError) as error:
            raise ImageError(f"The PNG is broken: {str(error)[:80]}.") from error
    # OpenCV takes the four bytes for blue, green, red and alpha.
    return np.nan_to_num(np.ascontiguousarray(rgba[..., [2, 1, 0, 3]]).view("<f4")[..., 0])


def colors_of(data: U8) -> U8:
    """Return the pixels (H, W, 3) of an image.

    Raises:
        ImageError: it is damaged.
    """
    header = inspect_compressed("", data)
    return np.asarray(opened(Encoded(header.mime, data, header.width, header.height)))


def matrix_of(data: U8) -> F32:
    """Return a compressed matrix of float32: (N, channels), one row per element.

    Raises:
        ImageError: it is damaged, or not of float32.
    """
    if len(data) < TRAILER:
        raise ImageError("The scan is cut off.")
    rows, columns, kind = np.frombuffer(data[-TRAILER:].tobytes(), "<i4").tolist()
    channels = (kind >> 3) + 1
    count = rows * columns * channels
    if kind & 7 != FLOATS or not rows > 0 or not columns > 0 or not 0 < count <= MAX_FLOATS:
        raise ImageError(f"The scan claims {rows} x {columns} elements of type {kind}.")
    try:
        plain = zlib.decompressobj().decompress(data[:-TRAILER].tobytes(), 4 * count)
    except zlib.error as error:
        raise ImageError(f"The scan is damaged: {error}.") from error
    if len(plain) != 4 * count:
        raise ImageError("The scan is cut off.")
    return np.frombuffer(plain, "<f4").reshape(-1, channels)
