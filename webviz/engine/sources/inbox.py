"""The inbox: a bounded queue per topic, filled by any thread."""

from __future__ import annotations

import threading
import time
from collections import deque
from dataclasses import dataclass, field

MAX_BYTES = 64 << 20
"""Of the messages of one topic between two calls of `drain`."""


@dataclass(frozen=True, slots=True)
class Raw:
    """A message as it arrived.

    Args:
        cdr: the serialised message with its encapsulation header.
        received_ns: ROS time of arrival.
        arrived_s: monotonic time of arrival, in seconds.
    """

    cdr: bytes
    received_ns: int
    arrived_s: float = field(default_factory=time.monotonic)


class Inbox:
    """Holds the messages that arrived since the last `drain`.

    Each topic is bounded in count and bytes: its oldest messages are dropped and counted.

    Args:
        max_bytes: per topic. The newest message is always kept, however large.
    """

    def __init__(self, max_bytes: int = MAX_BYTES) -> None:
        self._lock = threading.Lock()
        self._queues: dict[str, deque[Raw]] = {}
        self._limits: dict[str, int] = {}
        self._bytes: dict[str, int] = {}
        self._dropped: dict[str, int] = {}
        self._received: dict[str, tuple[int, int]] = {}
        self._max_bytes = max_bytes
        self.arrived = threading.Event()
        """Set by every arrival, and to wake the frame loop for other reasons."""

    def open(self, topic: str, limit: int) -> None:
        """Accept messages of a topic, at most `limit` between two calls of `drain`."""
        with self._lock:
            self._limits[topic] = limit

    def close(self, topic: str) -> None:
        """Discard the messages of a topic, and ignore new ones."""
        with self._lock:
            tables = (self._limits, self._queues, self._bytes, self._dropped, self._received)
            for table in tables:
                table.pop(topic, None)

    def put(self, topic: str, raw: Raw) -> None:
        """Add a message, unless its topic is closed."""
        with self._lock:
            limit = self._limits.get(topic)
            if limit is None:
                return
            count, total = self._received.get(topic, (0, 0))
            self._received[topic] = count + 1, total + len(raw.cdr)
            queue = self._queues.setdefault(topic, deque())
            queue.append(raw)
            size = self._bytes.get(topic, 0) + len(raw.cdr)
            while len(queue) > 1 and (len(queue) > limit or size > self._max_bytes):
                size -= len(queue.popleft().cdr)
                self._dropped[topic] = self._dropped.get(topic, 0) + 1
            self._bytes[topic] = size
        self.arrived.set()

    def drain(self) -> dict[str, deque[Raw]]:
        """Take all messages by topic, oldest first."""
        with self._lock:
            taken, self._queues, self._bytes = self._queues, {}, {}
        return taken

    def dropped(self, topic: str) -> int:
        """How many messages of a topic were dropped since it was opened."""
        with self._lock:
            return self._dropped.get(topic, 0)

    def received(self) -> dict[str, tuple[int, int]]:
        """How many messages and bytes arrived on each topic since it was opened."""
        with self._lock:
            return dict(self._received)
