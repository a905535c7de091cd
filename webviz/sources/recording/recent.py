"""The last seconds of what arrived, in memory."""

from __future__ import annotations

import threading
import time
from bisect import bisect_left
from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from webviz.sources.inbox import Raw

OVERHEAD = 200
"""Bytes of a message besides its own."""


class Remembered(NamedTuple):
    """A slice of the past.

    Args:
        latched: the newest message before the slice of each latched topic, by topic.
        messages: topics and messages, in the order of arrival.
    """

    latched: dict[str, Raw]
    messages: list[tuple[str, Raw]]


class RecentMessages:
    """Keeps raw messages of all topics for some seconds, as far as they fit; for any thread.

    The newest message of a latched topic is kept beyond that: without the map, the robot and static
    transforms, a slice of the past would show nothing.

    Args:
        is_latched: whether late subscribers receive the newest message of a topic.
        seconds, max_bytes: whichever is reached first.
    """

    def __init__(
        self, is_latched: Callable[[str], bool], seconds: float = 0.0, max_bytes: int = 0
    ) -> None:
        self._is_latched = is_latched
        self._lock = threading.Lock()
        self._messages: deque[tuple[str, Raw]] = deque()
        self._latched: dict[str, Raw] = {}
        self._bytes = 0
        self.seconds = seconds
        self.max_bytes = max_bytes

    def put(self, topic: str, raw: Raw) -> None:
        """Add a message, and forget the oldest that do not fit any more."""
        with self._lock:
            self._messages.append((topic, raw))
            self._bytes += len(raw.cdr) + OVERHEAD
            self._forget(raw.arrived_s)

    def size(self) -> tuple[float, int]:
        """Return the seconds since the oldest message, and the bytes of all."""
        now_s = time.monotonic()
        with self._lock:
            self._forget(now_s)
            latched = sum(len(raw.cdr) for raw in self._latched.values())
            oldest_s = self._messages[0][1].arrived_s if self._messages else now_s
            return now_s - oldest_s, self._bytes + latched

    def last(self, seconds: float) -> Remembered:
        """The messages of the last seconds, as far as they are remembered."""
        begin_s = time.monotonic() - seconds
        with self._lock:
            messages, latched = list(self._messages), dict(self._latched)
        first = bisect_left(messages, begin_s, key=lambda message: message[1].arrived_s)
        newest = dict(messages[:first])
        latched |= {topic: raw for topic, raw in newest.items() if self._is_latched(topic)}
        return Remembered(latched, messages[first:])

    def _forget(self, now_s: float) -> None:
        begin_s = now_s - self.seconds
        while self._messages:
            topic, raw = self._messages[0]
            if raw.arrived_s > begin_s and self._bytes <= self.max_bytes:
                return
            self._messages.popleft()
            self._bytes -= len(raw.cdr) + OVERHEAD
            if self._is_latched(topic):
                self._latched[topic] = raw
