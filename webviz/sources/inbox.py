"""The inbox: a bounded queue per topic, filled by any thread."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

from webviz.data.messages import KNOWN, MessageTypes

MAX_BYTES = 64 << 20
"""Limit in bytes of the messages of one topic between two calls of `drain`."""
MAX_TOTAL = 256 << 20
"""Limit in bytes of the messages of all topics."""
PAST_LIMIT = 20_000
"""Messages of the past on a topic: all latched ones arrive at once."""


@dataclass(frozen=True, slots=True)
class Earlier:
    """The messages of a topic before one of a recording, of which a seek read only some.

    Args:
        recorded_ns: times of recording of the last ones, the newest first.
        first_ns: that of the first one of all.
    """

    recorded_ns: Sequence[int]
    first_ns: int


@dataclass(frozen=True, slots=True)
class Raw:
    """A message as it arrived.

    Args:
        cdr: the serialised message with its encapsulation header.
        received_ns: ROS time of arrival.
        arrived_s: monotonic time of arrival, in seconds.
        recorded_ns: time of recording of one of a bag, 0 for a live one.
        earlier: the messages before it, if not all of them were delivered; for statistics.
        types: that define its type.
    """

    cdr: bytes
    received_ns: int
    arrived_s: float = field(default_factory=time.monotonic)
    recorded_ns: int = 0
    earlier: Earlier | None = None
    types: MessageTypes = KNOWN


class Inbox:
    """Holds the messages that arrived since the last `drain`.

    Each topic is bounded in count and bytes, and so are the bytes of all topics: the oldest
    messages of the topic, or of the one with the most bytes, are dropped and counted.

    Args:
        max_bytes: per topic. The newest message is kept, however large.
        max_total: of all topics. A message is kept, however large, if it is the only one.
    """

    def __init__(self, max_bytes: int = MAX_BYTES, max_total: int = MAX_TOTAL) -> None:
        self._lock = threading.Lock()
        self._queues: dict[str, deque[Raw]] = {}
        self._limits: dict[str, int] = {}
        self._bytes: dict[str, int] = {}
        self._dropped: dict[str, int] = {}
        self._received: dict[str, tuple[int, int]] = {}
        self._max_bytes = max_bytes
        self._max_total = max_total
        self._total = 0
        self._held_drops: int | None = None
        self._is_diverted = False
        self.readers: tuple[Callable[[str, Raw], object], ...] = ()
        """Called with each message by the thread that puts it, whatever is dropped later; quick."""
        self.arrived = threading.Event()
        """Set by every arrival, and to wake the frame loop for other reasons."""

    def open(self, topic: str, limit: int) -> None:
        """Accept messages of a topic, at most `limit` between two calls of `drain`."""
        with self._lock:
            self._limits[topic] = limit
            self._received.setdefault(topic, (0, 0))

    def close(self, topic: str) -> None:
        """Discard the messages of a topic, and ignore new ones."""
        with self._lock:
            self._total -= self._bytes.get(topic, 0)
            tables = (self._limits, self._queues, self._bytes, self._dropped, self._received)
            for table in tables:
                table.pop(topic, None)

    def put(self, topic: str, raw: Raw) -> None:
        """Add a message, unless its topic is closed; while diverted, only readers receive it."""
        with self._lock:
            if topic not in self._limits:
                return
            if not self._is_diverted:
                self._queue(topic, raw, self._limits[topic])
            for read in self.readers:
                read(topic, raw)
        self.arrived.set()

    def read_along(self, make: Callable[[], Callable[[str, Raw], object]]) -> None:
        """Add a reader, which `make` makes between two messages."""
        with self._lock:
            self.readers = (*self.readers, make())

    def forget(self, reader: Callable[[str, Raw], object]) -> None:
        """Remove a reader."""
        with self._lock:
            self.readers = tuple(each for each in self.readers if each != reader)

    def divert(self) -> None:
        """Keep new messages out of the queues, which `replay` fills until `rejoin`."""
        with self._lock:
            self._is_diverted = True

    def replay(self, topic: str, raw: Raw) -> None:
        """Queue a message of the past, which readers have received before or never do."""
        with self._lock:
            self._queue(topic, raw, PAST_LIMIT)
        self.arrived.set()

    def rejoin(self, missed: Callable[[], Iterable[tuple[str, Raw]]]) -> None:
        """Queue new messages again, after those that were missed; none comes in between."""
        with self._lock:
            for topic, raw in missed():
                if topic in self._limits:
                    self._queue(topic, raw, self._limits[topic])
            self._is_diverted = False
        self.arrived.set()

    def drain(self) -> dict[str, deque[Raw]]:
        """Take all messages by topic, oldest first."""
        with self._lock:
            queues, self._queues, self._bytes, self._total = self._queues, {}, {}, 0
            self._held_drops = None
        return queues

    def hold(self) -> int:
        """Let messages wait until the next `drain`, such as while paused.

        Returns:
            How many were dropped since the first call, which `dropped` does not count.
        """
        with self._lock:
            self._held_drops = self._held_drops or 0
            return self._held_drops

    def dropped(self, topic: str) -> int:
        """Return the messages of a topic dropped since it was opened, but for `hold`."""
        with self._lock:
            return self._dropped.get(topic, 0)

    def received(self) -> dict[str, tuple[int, int]]:
        """Return the messages and bytes received on each topic since it was opened."""
        with self._lock:
            return dict(self._received)

    def _queue(self, topic: str, raw: Raw, limit: int) -> None:
        count, total = self._received.get(topic, (0, 0))
        self._received[topic] = count + 1, total + len(raw.cdr)
        queue = self._queues.setdefault(topic, deque())
        queue.append(raw)
        self._count_bytes(topic, len(raw.cdr))
        while len(queue) > 1 and (len(queue) > limit or self._bytes[topic] > self._max_bytes):
            self._drop_oldest(topic)
        while self._total > self._max_total and self._total > len(raw.cdr):
            self._drop_oldest(max(self._bytes, key=self._bytes.__getitem__))

    def _count_bytes(self, topic: str, size: int) -> None:
        self._bytes[topic] = self._bytes.get(topic, 0) + size
        self._total += size

    def _drop_oldest(self, topic: str) -> None:
        self._count_bytes(topic, -len(self._queues[topic].popleft().cdr))
        if self._held_drops is None:
            self._dropped[topic] = self._dropped.get(topic, 0) + 1
        else:
            self._held_drops += 1
