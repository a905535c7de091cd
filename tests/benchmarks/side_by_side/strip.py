"""Marks in maps: black and white blocks that survive palettes, tiles and JPEG.

Sixteen blocks by which the strip is found, three for the lane, thirteen for the publication. A
block is 4 x 4 cells on a grid of 4 cells, so that one cell of four is looked at.
"""

from __future__ import annotations

import io

import numpy as np
import PIL.Image
from numpy.typing import NDArray

BLOCK = 4
SYNC = np.array([int(c) for c in "1011100010110010"], bool)
LANE_BITS, NUMBER_BITS = 3, 13
LENGTH = len(SYNC) + LANE_BITS + NUMBER_BITS
CYCLE = 1 << NUMBER_BITS
FREE, OCCUPIED = 0, 100
GAP = 77
"""Fills the place of a strip in a message."""


def cells(lane: int, publication: int) -> NDArray[np.int8]:
    """The strip as values of a map: int8 (4, 128)."""
    code = lane << NUMBER_BITS | publication % CYCLE
    bits = [code >> i & 1 for i in reversed(range(LANE_BITS + NUMBER_BITS))]
    row = np.where(np.concatenate([SYNC, bits]), OCCUPIED, FREE).astype(np.int8)
    return np.tile(np.repeat(row, BLOCK), (BLOCK, 1))


def read(picture: bytes) -> list[tuple[int, int]]:
    """Lane and publication (modulo CYCLE) of every strip in a PNG or JPEG."""
    image = PIL.Image.open(io.BytesIO(picture))
    width, height = image.size
    image.draft(None, (width // BLOCK, height // BLOCK))  # a JPEG with a pixel for each block
    red = np.asarray(image.convert("RGBA"))[:, :, 0]
    step = BLOCK if image.width == width else 1
    is_set = red[step // 2 :: step, step // 2 :: step] < 128
    last = is_set.shape[1] - LENGTH + 1
    if last < 1:
        return []
    results = []
    for ones in (is_set, ~is_set):  # a palette may show occupied cells dark or bright
        fits = np.ones((len(ones), last), bool)
        for i, bit in enumerate(SYNC):
            fits &= ones[:, i : i + last] == bit
        for row, column in np.argwhere(fits):
            bits = ones[row, column + len(SYNC) : column + LENGTH]
            code = int("".join("01"[bit] for bit in bits.astype(int)), 2)
            results.append((code >> NUMBER_BITS, code % CYCLE))
    return results
