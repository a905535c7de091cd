"""The clock of a bridge, compared with the clock of this machine."""

from __future__ import annotations

from webviz.sources.bridge.backlog import LinkDelay

TOLERANCE_NS = 50_000_000
"""Difference in ns below which it may come from the link, which is not equally fast both ways."""


class BridgeClock:
    """Estimates by how much the clock of a bridge is ahead.

    The fastest message of the last minute took about half of the shortest round trip; the rest of
    the difference between its arrival and its stamp is that of the clocks, as in NTP. Written by
    the thread of the connection, read by all.
    """

    def __init__(self) -> None:
        self.ahead_ns = 0
        """Nanoseconds to subtract from stamps of the robot; 0 below `TOLERANCE_NS`."""
        self.start()

    def start(self) -> None:
        """Measure anew, as the link is another; the result of before holds until then."""
        self._delay = LinkDelay()
        self._trip_s: float | None = None

    @property
    def trip_s(self) -> float:
        """The shortest round trip; 0 before one."""
        return self._trip_s or 0.0

    def note_trip(self, seconds: float) -> None:
        """Note a round trip."""
        self._trip_s = seconds if self._trip_s is None else min(seconds, self._trip_s)

    def note(self, stamp_ns: int, arrived_ns: int) -> None:
        """Note a message, with the wall times at which the bridge and this machine received it."""
        self._delay.note(stamp_ns / 1e9, arrived_ns / 1e9)
        ahead_ns = -round((self._delay.least_s - self.trip_s / 2) * 1e9)
        # It drifts slowly: a difference that changed with each message would let frames tremble.
        if abs(ahead_ns - self.ahead_ns) > TOLERANCE_NS:
            self.ahead_ns = ahead_ns if abs(ahead_ns) > TOLERANCE_NS else 0
