"""The camera infos of images, by stamp."""

from __future__ import annotations

from collections import OrderedDict
from typing import Any

from webviz import Sample

MAX_INFOS = 30
FAR_APART_NS = 200_000_000
SKIPPED_NS = 2_000_000_000
"""The same if images had the camera info of their stamp: a busy machine skips those of some."""


class Infos:
    """The newest camera infos: that of an image may arrive before it or after it."""

    def __init__(self) -> None:
        self._by_stamp: OrderedDict[int, Any] = OrderedDict()
        self._are_alike = False

    def put(self, sample: Sample) -> None:
        """Take a camera info."""
        self._by_stamp.pop(sample.stamp_ns, None)
        self._by_stamp[sample.stamp_ns] = sample.message
        while len(self._by_stamp) > MAX_INFOS:
            self._by_stamp.popitem(last=False)

    def of(self, stamp_ns: int) -> tuple[Any, float]:
        """Return the camera info with the stamp of an image, else the newest one.

        Returns:
            The message, and by how many seconds the nearest stamp differs if that is suspicious:
            a single camera info is good for all images.

        Raises:
            LookupError: there is none.
        """
        if not self._by_stamp:
            raise LookupError("no camera info")
        found = self._by_stamp.get(stamp_ns)
        if found is not None:
            self._are_alike = True
            return found, 0.0
        message = next(reversed(self._by_stamp.values()))
        apart = min(abs(stamp - stamp_ns) for stamp in self._by_stamp)
        far_apart = SKIPPED_NS if self._are_alike else FAR_APART_NS
        is_suspicious = len(self._by_stamp) > 1 and stamp_ns and apart > far_apart
        return message, apart / 1e9 if is_suspicious else 0.0
