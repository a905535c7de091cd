"""Congestion control: the throughput of a browser, and the bytes allowed on their way to it.

What is written to a socket cannot be overtaken any more: on a slow link it waits in buffers of the
kernel, of routers and of tunnels, and everything after it waits as well. Hence only as much is on
its way as the link takes in its own time plus `QUEUE_S`; the rest waits in webviz, where newer
messages replace older ones.

Each stretch of what is sent ends with a websocket ping, whose pong says that the browser has it.
From the pongs follow the rate of delivery and the shortest round trip, as in BBR ("BBR:
Congestion-Based Congestion Control", ACM Queue 14 (5), 2016). A link that never makes anybody wait
is not measured, and costs a ping every five seconds.
"""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections import deque
from collections.abc import Callable

import msgspec

QUEUE_S = 0.1
"""Seconds by which what is on its way may delay what comes after it."""
FIRST_WINDOW = 1 << 16
"""Bytes that may be on their way at first."""
MIN_WINDOW = 1 << 13
MAX_WINDOW = 1 << 26
MEMORY_S = 2.0
"""Time in seconds for which a rate of delivery counts."""
GOOD = 0.75
"""Share of the rates of delivery that the assumed one exceeds: pauses of a busy browser, and pongs
that come late, do not make a link slow."""
FAST = 12.5e6
"""Bytes a second from which on a link is not throttled."""
STALLED_S = 1.0
"""A browser that does not answer for so long is sent nothing until it does."""
REST_S = 5.0
"""Seconds between pings while little is sent."""


class SentMarker(msgspec.Struct, frozen=True, eq=False):
    """A ping on its way.

    Args:
        size: bytes of its connection since the ping before.
        began: when the first of them was sent.
        sent_at: when it was sent.
        in_flight: bytes on their way then, with these.
        delivered: bytes that had arrived by then.
        acknowledged: when the last pong before came.
        is_limited: whether anything had to wait since the ping before.
    """

    size: int
    began: float
    sent_at: float
    in_flight: int
    delivered: int
    acknowledged: float
    is_limited: bool


class CongestionControl:
    """The link to one browser, over all of its connections; belongs to the event loop.

    Only `rate`, `every` and `shrink` are for other threads, too.

    Args:
        limit: bytes a second that the link is known to take; None to measure it.
        clock: the time in seconds.
    """

    def __init__(
        self, limit: float | None = None, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._limit = limit
        self.clock = clock
        self.rate: float | None = limit
        """Bytes a second that the link takes; None while it is fast enough, or not known."""
        self.every = 1
        """Number of points of clouds of which one is sent."""
        self.shrink = 1
        """Factor by which images are made smaller because of the link."""
        self.in_flight = 0
        """Bytes that were sent and may not have arrived."""
        self._window = float(FIRST_WINDOW if limit is None else limit * QUEUE_S)
        self._is_starting = limit is None
        self._paid_until = 0.0
        self._marks: dict[SentMarker, None] = {}
        self._delivered = 0
        self._acknowledged = 0.0
        self._pinged = -REST_S
        self._trip: float | None = None
        self._rates: deque[tuple[float, float]] = deque()
        self._is_limited = False
        self._limited_at = 0.0
        self._freed = asyncio.Event()

    def room(self, share: float = 1.0) -> int:
        """Return the number of bytes that may be sent now, 0 if that is less than 1.

        Args:
            share: of the usual window.
        """
        room = share * self._window - self.in_flight
        if not self._marks:  # so that there will be a pong
            room = max(room, MIN_WINDOW)
        elif self.clock() - next(iter(self._marks)).sent_at > STALLED_S:
            room = 0
        if self._limit is not None:
            room = min(
                room, self._limit * (share * QUEUE_S - max(0.0, self._paid_until - self.clock()))
            )
        if room < 1:
            self._is_limited = True
        return int(room)

    async def wait(self) -> None:
        """Wait until there may be room again, at most a moment."""
        self._freed.clear()
        patience = QUEUE_S / 4 if self._limit is not None else QUEUE_S
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(self._freed.wait(), patience)

    def piece(self) -> int:
        """Bytes that may be written at once: what the link takes in half of `QUEUE_S`."""
        if self.rate is None:
            return MAX_WINDOW
        return max(MIN_WINDOW, int(self.rate * QUEUE_S / 2))

    def send(self, size: int) -> None:
        """Count bytes that are being sent."""
        self.in_flight += size
        if self._limit is not None:
            self._paid_until = max(self._paid_until, self.clock()) + size / self._limit

    def wants_ping(self, size: int) -> bool:
        """Return whether a ping should follow, `size` bytes after the last on its connection."""
        return size > 0 and (
            size >= self._window / 4
            or self.in_flight >= self._window
            or self.clock() - self._pinged >= REST_S
        )

    def marker(self, size: int, began: float) -> SentMarker:
        """Note a ping that is being sent; see `SentMarker`."""
        now = self._pinged = self.clock()
        marker = SentMarker(
            size, began, now, self.in_flight, self._delivered, self._acknowledged, self._is_limited
        )
        self._marks[marker] = None
        self._is_limited = False
        return marker

    def lose(self, marker: SentMarker) -> None:
        """Forgets a ping whose connection has ended."""
        del self._marks[marker]
        self.in_flight -= marker.size
        self._freed.set()

    def acknowledge(self, marker: SentMarker) -> None:
        """Learns from the pong of a ping."""
        self.lose(marker)
        now = self.clock()
        self._delivered += marker.size
        self._acknowledged = now
        trip = now - marker.sent_at
        if self._trip is None or trip < self._trip:
            self._trip = trip
        elif marker.in_flight <= MIN_WINDOW:  # the way itself has become longer
            self._trip += (trip - self._trip) / 8
        if marker.is_limited:
            rate = (self._delivered - marker.delivered) / max(now - marker.acknowledged, 1e-4)
        else:
            rate = marker.size / max(now - marker.began, 1e-4)
        queue_s = trip - self._trip
        rate = self._limit or self._learn(rate, queue_s, marker)
        fitting = min(max(MIN_WINDOW, rate * (self._trip + QUEUE_S)), MAX_WINDOW)
        if self._is_starting:
            self._is_starting = not (marker.is_limited and queue_s > QUEUE_S)
        if self._is_starting:
            grown = self._window + (marker.size if marker.is_limited else 0)
            self._window = min(max(grown, fitting), MAX_WINDOW)
        else:
            self._window = fitting
            self.rate = rate if rate < FAST else None

    def _learn(self, rate: float, queue_s: float, marker: SentMarker) -> float:
        """Return the rate of late.

        `queue_s` is by how much longer a pong took than the shortest.
        """
        known_rate = self._known_rate()
        if marker.is_limited:
            self._limited_at = self._acknowledged
        elif (
            self._acknowledged - self._limited_at > MEMORY_S
            and marker.in_flight > self._window / 4
            and queue_s < QUEUE_S / 2
        ):
            rate = max(rate, known_rate * 1.25)  # nothing waits: the link may have become faster
        if marker.is_limited or rate > known_rate:
            while self._rates and self._rates[0][0] < self._acknowledged - MEMORY_S:
                self._rates.popleft()
            self._rates.append((self._acknowledged, rate))
        return self._known_rate()

    def _known_rate(self) -> float:
        rates = sorted(rate for _, rate in self._rates)
        return rates[int(GOOD * len(rates))] if rates else 0.0


class InFlightWindow:
    """In-flight window: bytes one connection of a browser has sent since its last ping.

    Args:
        congestion: of the link to the browser.
    """

    def __init__(self, congestion: CongestionControl) -> None:
        self.congestion = congestion
        self._size = 0
        self._began = 0.0

    def join(self, congestion: CongestionControl) -> None:
        """Count for another pace from now on: that of all connections of its browser."""
        congestion.send(self._size)
        self.congestion = congestion

    def send(self, size: int) -> None:
        """Count bytes that are being sent."""
        if not self._size:
            self._began = self.congestion.clock()
        self._size += size
        self.congestion.send(size)

    @property
    def is_due(self) -> bool:
        """Return whether a ping should follow."""
        return self.congestion.wants_ping(self._size)

    def end(self) -> SentMarker | None:
        """End it if a ping should follow; return what the pong acknowledges."""
        if not self.is_due:
            return None
        marker = self.congestion.marker(self._size, self._began)
        self._size = 0
        return marker

    def drop(self) -> None:
        """Forgets what was sent, as the connection has ended."""
        self.congestion.in_flight -= self._size
        self._size = 0
