"""Times of recording of messages that arrive."""

from __future__ import annotations

import time


class WallClock:
    """Times since 1970, which are steady whatever happens to other clocks."""

    def __init__(self) -> None:
        self._offset_ns = time.time_ns() - time.monotonic_ns()

    def now_ns(self) -> int:
        """Return the time."""
        return time.monotonic_ns() + self._offset_ns

    def stamp_ns(self, arrived_s: float) -> int:
        """Return the time of recording of a message that arrived at a monotonic time in seconds."""
        return round(arrived_s * 1e9) + self._offset_ns

    def arrived_s(self, stamp_ns: int) -> float:
        """Return the monotonic time of a time of recording, in seconds."""
        return (stamp_ns - self._offset_ns) / 1e9
