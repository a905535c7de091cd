"""The order of many points that browsers thin by themselves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import POINTS_PER_BLOCK
from webviz_displays.point_cloud2.decimation import Rows, evenly

_BITS = 16
"""Of the number of a cell: numpy sorts numbers of 16 bits by radix, ten times as fast."""

_SAMPLE = 10_000
"""Points from which the extent is estimated."""


def in_blocks(xyz: NDArray[np.float32]) -> Rows:
    """Return the rows of points (N, 3) in an order for `Points.thins`.

    The first `POINTS_PER_BLOCK` of them are from everywhere. Each further block has points that are
    near each other, shuffled: the first of them stand for all of it. Blocks follow each other at
    random, too, so that a cloud that is sent one after another becomes denser everywhere at once.

    Args:
        xyz: finite points, metres; at least one.
    """
    rng = np.random.default_rng(0)
    first = evenly(len(xyz), min(len(xyz), POINTS_PER_BLOCK))
    others = np.ones(len(xyz), np.bool_)
    others[first] = False
    rows = np.argsort(_cells(xyz), kind="stable")
    rows = rows[others[rows]]
    whole = len(rows) // POINTS_PER_BLOCK
    blocks = rows[: whole * POINTS_PER_BLOCK].reshape(whole, POINTS_PER_BLOCK)
    blocks = blocks[rng.permutation(whole)][:, rng.permutation(POINTS_PER_BLOCK)]
    rest = rng.permutation(rows[whole * POINTS_PER_BLOCK :])
    return np.concatenate((first, blocks.reshape(-1), rest))


def _cells(xyz: NDArray[np.float32]) -> NDArray[np.uint16]:
    """Return the number (N,) of the cell of each point.

    Cells with numbers near each other are neighbours.

    The box around most points is halved again and again across its longest side; each half is a
    bit. With equal sides this is the Morton order.
    """
    some = xyz[:: max(len(xyz) // _SAMPLE, 1)]
    low, high = np.percentile(some, (1, 99), axis=0)
    extent = np.maximum(high - low, 1e-6)
    steps = 1 << _BITS
    with np.errstate(over="ignore"):
        places = [
            np.clip((xyz[:, axis] - low[axis]) * (steps / extent[axis]), 0, steps - 1).astype(
                np.uint16
            )
            for axis in range(3)
        ]
    numbers = np.zeros(len(xyz), np.uint16)
    sides, halved = extent.copy(), [0, 0, 0]
    for bit in reversed(range(_BITS)):
        axis = int(np.argmax(sides))
        sides[axis] /= 2
        halved[axis] += 1
        numbers |= ((places[axis] >> (_BITS - halved[axis])) & 1) << bit
    return numbers
