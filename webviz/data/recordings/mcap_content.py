"""The messages of a chunk of an MCAP file."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import msgspec
import numpy as np
import numpy.typing as npt

SMALL = 16 << 10
"""Bytes of a message. Transforms and scans have less, images and clouds more."""


class ChunkContent(msgspec.Struct, frozen=True):
    """Messages in the order of the file.

    Args:
        data: in which they are.
        numbers: uint16 (N,), of their channels.
        stamps: uint64 (N,), times of recording in ns.
        starts, ends: offsets of each in the data, N each.
        left_out: numbers of the channels whose messages are missing here.
    """

    data: bytes
    numbers: npt.NDArray[np.uint16]
    stamps: npt.NDArray[np.uint64]
    starts: Sequence[int]
    ends: Sequence[int]
    left_out: Sequence[int] = ()

    def small(self) -> ChunkContent:
        """Return the messages of the channels that have small ones only."""
        sizes = np.subtract(self.ends, self.starts, dtype=np.int64)
        left_out = np.unique(self.numbers[sizes > SMALL])
        if not len(left_out):
            return self
        kept = np.flatnonzero(~np.isin(self.numbers, left_out))
        rows = kept.tolist()
        bounds = [0, *itertools.accumulate(sizes[kept].tolist())]
        return ChunkContent(
            b"".join(self.data[self.starts[row] : self.ends[row]] for row in rows),
            self.numbers[kept],
            self.stamps[kept],
            bounds[:-1],
            bounds[1:],
            left_out.tolist(),
        )
