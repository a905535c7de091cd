"""RVL: lossless compression of depth images.

A. D. Wilson, "Fast Lossless Depth Image Compression", ISS 2017. All numbers are of nibbles with
three bits each, the lowest first; the fourth bit says that another nibble follows.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from webviz.data.images.errors import ImageError
from webviz.data.images.raw import MAX_PIXELS

_LONGEST = 11
"""Nibbles of a number of 32 bits."""
_NIBBLES_PER_PIXEL = 6
"""At most, of a difference of 17 bits; runs of single pixels take less."""


def decode_rvl(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    """The values (H, W) of an RVL stream behind its size, two uint32: columns and rows.

    Raises:
        ImageError: it is broken.
    """
    if len(data) < 8:
        raise ImageError("The RVL image has no header: the publisher sends no data.")
    columns, rows = (int(n) for n in np.frombuffer(data[:8].tobytes(), "<u4"))
    if not 0 < columns * rows <= MAX_PIXELS:
        raise ImageError(f"The RVL image claims {columns} x {rows} pixels.")
    numbers = _numbers(data[8 : 8 + columns * rows * _NIBBLES_PER_PIXEL // 2 + 16])
    return _pixels(numbers, columns * rows).reshape(rows, columns)


def _numbers(data: NDArray[np.uint8]) -> NDArray[np.int64]:
    """All numbers of a stream of little-endian words, whose upper nibbles come first."""
    whole = np.frombuffer(data[: len(data) // 4 * 4].tobytes(), np.uint8).reshape(-1, 4)[:, ::-1]
    nibbles = np.stack((whole >> 4, whole & 15), axis=-1).reshape(-1)
    ends = np.flatnonzero(nibbles < 8)
    if not len(ends):
        raise ImageError("The RVL image is broken: it holds no number.")
    starts = np.concatenate(([0], ends[:-1] + 1))
    if int((ends - starts).max()) >= _LONGEST:
        raise ImageError("The RVL image is broken: a number is too long.")
    bits = (nibbles[: ends[-1] + 1] & 7).astype(np.int64)
    places = np.arange(len(bits)) - np.repeat(starts, ends - starts + 1)
    return np.add.reduceat(bits << (3 * places), starts)


def _pixels(numbers: NDArray[np.int64], count: int) -> NDArray[np.uint16]:
    """Runs of zeros and of differences to the pixel before them, which zeros do not interrupt."""
    is_difference = np.zeros(len(numbers), bool)
    pixels = np.zeros(count, np.uint16)
    is_measured = np.zeros(count, bool)
    pixel = at = 0
    while pixel < count:
        if at + 2 > len(numbers):
            raise ImageError("The RVL image is incomplete.")
        pixel += int(numbers[at])
        length = int(numbers[at + 1])
        if at and not numbers[at] and not length:
            # Millions of these would take minutes.
            raise ImageError("The RVL image is broken: it holds a run without a pixel.")
        at += 2
        if pixel + length > count or at + length > len(numbers):
            raise ImageError("The RVL image is broken: it has more pixels than its size says.")
        is_difference[at : at + length] = True
        is_measured[pixel : pixel + length] = True
        pixel, at = pixel + length, at + length
    coded = numbers[is_difference]
    differences = (coded >> 1) ^ -(coded & 1)
    pixels[is_measured] = np.cumsum(differences).astype(np.uint16)
    return pixels
