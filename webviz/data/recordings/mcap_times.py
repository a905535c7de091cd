"""The chunks of an MCAP file that have messages of some channels within a span of time."""

from __future__ import annotations

from collections.abc import Sequence, Set

import numpy as np
import numpy.typing as npt

from webviz.data.recordings.mcap_chunks import McapChunk


class ChunkTimes:
    """Finds chunks without looking at each, as a file of gigabytes has tens of thousands.

    Args:
        chunks: of a file, the first one first.
    """

    def __init__(self, chunks: Sequence[McapChunk]) -> None:
        self._starts = np.array([chunk.start_ns for chunk in chunks], np.uint64)
        self._ends = np.array([chunk.end_ns for chunk in chunks], np.uint64)
        self._from_end = np.argsort(self._ends, kind="stable")[::-1]
        self._unknown = np.array([chunk.counts is None for chunk in chunks], bool)
        """Chunks that may have messages of any channel."""
        self._by_channel = _by_channel(chunks)

    def within(self, numbers: Set[int], start_ns: int, end_ns: int, sign: int) -> Sequence[int]:
        """Return the chunks that may have messages of channels within a span, both ends included.

        Args:
            numbers: of the channels.
            start_ns, end_ns: the span.
            sign: 1 for the chunk that starts first, -1 for the one that ends last at the front.

        Returns:
            Indices of chunks.
        """
        is_inside = self._unknown.copy()
        for number in self._by_channel.keys() & numbers:
            is_inside[self._by_channel[number]] = True
        is_inside &= (self._starts <= end_ns) & (self._ends >= start_ns)
        if sign > 0:
            return np.flatnonzero(is_inside).tolist()
        return self._from_end[is_inside[self._from_end]].tolist()


def _by_channel(chunks: Sequence[McapChunk]) -> dict[int, npt.NDArray[np.int64]]:
    """Return the indices of the chunks that have messages of a channel, by its number."""
    counts = [(index, chunk.counts) for index, chunk in enumerate(chunks)]
    known = [(index, each["channel"]) for index, each in counts if each is not None]
    if not known:
        return {}
    numbers = np.concatenate([each for _, each in known])
    sizes = [len(each) for _, each in known]
    owners = np.repeat(np.array([index for index, _ in known], np.int64), sizes)
    order = np.argsort(numbers, kind="stable")
    found, firsts = np.unique(numbers[order], return_index=True)
    parts = np.split(owners[order], firsts[1:])
    return dict(zip(found.tolist(), parts, strict=True))
