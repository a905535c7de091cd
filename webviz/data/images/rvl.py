"""RVL: lossless compression of depth images.

A. D. Wilson, "Fast Lossless Depth Image Compression", ISS 2017. All numbers are of nibbles with
three bits each, the lowest first; the fourth bit says that another nibble follows.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from webviz.data.images.compressed import decoding
from webviz.data.images.errors import ImageError
from webviz.data.images.raw import MAX_PIXELS

_LONGEST = 11
"""Nibbles of a number of 32 bits."""
_NIBBLES_PER_PIXEL = 6
"""Largest number of nibbles per pixel, of a difference of 17 bits; runs of single pixels take
less."""
_PART_BYTES = 1 << 18
"""Decoded at once: each takes about 100 bytes on its way to a number."""
_PIXEL_BYTES = 30
"""Bytes that a pixel takes on its way, at most: 28 were measured, of runs of single pixels."""
_BLOCK = 1 << 14
"""Numbers among which runs are followed at once."""


def decode_rvl(data: NDArray[np.uint8]) -> NDArray[np.uint16]:
    """Return the values (H, W) of an RVL stream behind its size, two uint32: columns and rows.

    Raises:
        ImageError: it is broken.
    """
    if len(data) < 8:
        raise ImageError("The RVL image has no header: the publisher sends no data.")
    columns, rows = (int(n) for n in np.frombuffer(data[:8].tobytes(), "<u4"))
    if not 0 < columns * rows <= MAX_PIXELS:
        raise ImageError(f"The RVL image claims {columns} x {rows} pixels.")
    with decoding(columns, rows, _PIXEL_BYTES):
        numbers = _numbers(data[8 : 8 + columns * rows * _NIBBLES_PER_PIXEL // 2 + 16])
        return _pixels(numbers, columns * rows).reshape(rows, columns)


def _numbers(data: NDArray[np.uint8]) -> NDArray[np.int32]:
    """All numbers of a stream of little-endian words, whose upper nibbles come first."""
    numbers: list[NDArray[np.int32]] = []
    rest = np.zeros(0, np.uint8)
    whole = data[: len(data) // 4 * 4]
    for at in range(0, len(whole), _PART_BYTES):
        words = whole[at : at + _PART_BYTES].reshape(-1, 4)[:, ::-1]
        pairs = np.stack((words >> np.uint8(4), words & np.uint8(15)), axis=-1)
        nibbles: NDArray[np.uint8] = np.concatenate((rest, pairs.reshape(-1)))
        ends = np.flatnonzero(nibbles < 8)
        stop = int(ends[-1]) + 1 if len(ends) else 0
        rest = nibbles[stop:]
        starts = np.concatenate(([0], ends[:-1] + 1)) if stop else ends
        if max(int((ends - starts).max(initial=0)), len(rest)) >= _LONGEST:
            raise ImageError("The RVL image is broken: a number is too long.")
        if stop:
            numbers.append(_joined(nibbles[:stop], starts, ends))
    if not numbers:
        raise ImageError("The RVL image is broken: it holds no number.")
    return np.concatenate(numbers)


def _joined(
    nibbles: NDArray[np.uint8], starts: NDArray[np.intp], ends: NDArray[np.intp]
) -> NDArray[np.int32]:
    """Return the numbers whose nibbles are from `starts` to `ends`."""
    places = np.arange(len(nibbles)) - np.repeat(starts, ends - starts + 1)
    numbers = np.add.reduceat((nibbles & 7).astype(np.int64) << (3 * places), starts)
    # No run and no difference is as large as that.
    return np.minimum(numbers, np.iinfo(np.int32).max).astype(np.int32)


def _pixels(numbers: NDArray[np.int32], count: int) -> NDArray[np.uint16]:
    """Return pixels from runs of zeros and of differences to the pixel before, zeros left out."""
    runs = _runs(numbers, count)
    lengths = np.stack((numbers[runs], numbers[runs + 1]), axis=-1).reshape(-1)
    end = int(runs[-1]) + 2 + int(lengths[-1])
    if end > len(numbers):
        raise ImageError("The RVL image is incomplete.")
    is_difference = np.ones(end, bool)
    is_difference[runs] = is_difference[runs + 1] = False
    coded = numbers[:end][is_difference]
    differences = (coded >> 1) ^ -(coded & 1)
    pixels = np.zeros(count, np.uint16)
    is_measured = np.repeat(np.tile((False, True), len(runs)), lengths)
    pixels[is_measured] = np.cumsum(differences.astype(np.uint16), dtype=np.uint16)
    return pixels


def _runs(numbers: NDArray[np.int32], count: int) -> NDArray[np.intp]:
    """Return where runs begin: with the number of zeros, then that of the differences that follow.

    Each says where the next one begins. They are followed from block to block, and in a block by
    doubling: who knows the places up to 2^n runs ahead knows those up to 2^(n + 1).
    """
    run_lists: list[NDArray[np.intp]] = []
    at, left = 0, count
    while left:
        zeros, lengths = numbers[at : at + _BLOCK], numbers[at + 1 : at + 1 + _BLOCK]
        size = len(lengths)
        if not size:
            raise ImageError("The RVL image is incomplete.")
        ahead = np.append(np.minimum(np.arange(size) + 2 + lengths, size), size)
        runs = np.zeros(1, np.intp)
        while len(further := ahead[runs][ahead[runs] < size]):
            runs = np.concatenate((runs, further))
            ahead = ahead[ahead]
        pixels = zeros[runs].astype(np.int64) + lengths[runs]
        totals = np.cumsum(pixels)
        enough = int(np.searchsorted(totals, left)) + 1
        if not pixels[0 if at else 1 : enough].all():
            # Millions of these might be no image at all.
            raise ImageError("The RVL image is broken: it holds a run without a pixel.")
        runs, left = runs[:enough], left - int(totals[:enough][-1])
        if left < 0:
            raise ImageError("The RVL image is broken: it has more pixels than its size says.")
        run_lists.append(at + runs)
        at += int(runs[-1]) + 2 + int(lengths[runs[-1]])
    return np.concatenate(run_lists)
