"""The camera infos of images, by stamp."""

from __future__ import annotations

from collections import OrderedDict
from typing import Any

from webviz import Sample

MOST = 30
FAR_APART_NS = 200_000_000


class Infos:
    """The newest camera infos: that of an image may arrive before it or after it."""

    def __init__(self) -> None:
        self._by_stamp: OrderedDict[int, Any] = OrderedDict()

    def put(self, sample: Sample) -> None:
        """Take a camera info."""
        self._by_stamp.pop(sample.stamp_ns, None)
        self._by_stamp[sample.stamp_ns] = sample.message
        while len(self._by_stamp) > MOST:
            self._by_stamp.popitem(last=False)

    def of(self, stamp_ns: int) -> tuple[Any, float]:
        """The camera info with the stamp of an image, else the newest one.

        Returns:
            The message, and by how many seconds its stamp differs in a way that is suspicious:
            a single camera info is good for all images.

        Raises:
            LookupError: there is none.
        """
        if not self._by_stamp:
            raise LookupError("no camera info")
        found = self._by_stamp.get(stamp_ns)
        if found is not None:
            return found, 0.0
        newest, message = next(reversed(self._by_stamp.items()))
        apart = abs(newest - stamp_ns)
        is_suspicious = len(self._by_stamp) > 1 and stamp_ns and apart > FAR_APART_NS
        return message, apart / 1e9 if is_suspicious else 0.0
