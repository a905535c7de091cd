"""The last seconds of what arrived, in memory."""

from __future__ import annotations

import itertools
import math
import threading
import time
from bisect import bisect_left
from collections import Counter, deque
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from webviz.data.recordings.latched import LatchedMessages, has_transforms
from webviz.sources.inbox import Raw

OVERHEAD = 200
"""Bytes of a message besides its own."""
MAX_PINNED_BYTES = 128_000_000
"""Of all messages that are kept beyond the bounds; the newest is, however large."""

MAX_PARTS = 240
"""Parts of the time that is remembered in which messages are counted."""
MIN_PART_S = 1.0

Entry = tuple[str, Raw]
"""Topic and message."""


class Remembered(NamedTuple):
    """A slice of the past.

    Args:
        latched: the newest messages before the slice of each latched topic, and the last transforms
            of each frame.
        messages: topics and messages, in the order of arrival.
    """

    latched: list[Entry]
    messages: list[Entry]

    @property
    def whole(self) -> list[Entry]:
        """All of them, the latched ones as if they had arrived with the first of the slice."""
        if not self.messages:
            return self.latched
        first = self.messages[0][1]
        times = {"received_ns": first.received_ns, "arrived_s": first.arrived_s}
        return [*((topic, replace(raw, **times)) for topic, raw in self.latched), *self.messages]


class RecentMessages:
    """Keeps raw messages of all topics for some seconds, as far as they fit; for any thread.

    The newest latched messages are kept beyond that, and the last transforms of each frame: without
    the map, the robot and static transforms, a slice of the past would show nothing, and a frame
    whose transforms ended would be unknown.

    Args:
        latched: number of messages of a topic that late subscribers receive.
        seconds, max_bytes: whichever is reached first.
    """

    def __init__(
        self, latched: Callable[[str], int], seconds: float = 0.0, max_bytes: int = 0
    ) -> None:
        self._depth = latched
        self._lock = threading.Lock()
        self._messages: deque[Entry] = deque()
        self._latched = LatchedMessages[Raw]()
        self._bytes = 0
        self._full_s: float | None = None
        self._part_s = MIN_PART_S
        self._counts: dict[str, Counter[int]] = {}
        """Messages by topic and part, which is the number of parts since time began."""
        self.forgotten_s = -math.inf
        """Arrival of the newest message that was forgotten, in monotonic seconds."""
        self.seconds = seconds
        self.max_bytes = max_bytes

    @property
    def is_on(self) -> bool:
        """Return whether anything is kept."""
        return self.seconds > 0 and self.max_bytes > 0

    def put(self, topic: str, raw: Raw) -> None:
        """Add a message, and forget the oldest that do not fit any more."""
        with self._lock:
            self._messages.append((topic, raw))
            self._bytes += len(raw.cdr) + OVERHEAD
            self._count(topic, raw, 1)
            self._forget(raw.arrived_s)

    def size(self) -> tuple[float, int]:
        """Return the seconds since the oldest message, and the bytes of all."""
        now_s = time.monotonic()
        with self._lock:
            self._forget(now_s)
            latched = sum(len(raw.cdr) for _, raw in self._latched)
            oldest_s = self._messages[0][1].arrived_s if self._messages else now_s
            return now_s - oldest_s, self._bytes + latched

    @property
    def oldest_s(self) -> float | None:
        """Return when the oldest message arrived, in monotonic seconds; None without any."""
        with self._lock:
            return self._messages[0][1].arrived_s if self._messages else None

    @property
    def newest_s(self) -> float | None:
        """Return when the newest message arrived, in monotonic seconds; None without any."""
        with self._lock:
            return self._messages[-1][1].arrived_s if self._messages else None

    @property
    def is_full(self) -> bool:
        """Return whether messages younger than `seconds` were forgotten for their size."""
        full_s = self._full_s
        return full_s is not None and time.monotonic() - full_s < self.seconds

    def pinned(self) -> tuple[str, ...]:
        """Return the topics of which messages are kept although they are old."""
        with self._lock:
            return self._latched.topics()

    def last(self, seconds: float) -> Remembered:
        """Return the messages of the last seconds, as far as they are remembered."""
        begin_s = time.monotonic() - seconds
        with self._lock:
            messages = list(self._messages)
            latched = self._latched.copy()
        first = bisect_left(messages, begin_s, key=lambda message: message[1].arrived_s)
        for topic, raw in messages[:first]:
            self._pin(latched, topic, raw)
        return Remembered(_flat(latched), messages[first:])

    def after(self, arrived_s: float) -> list[Entry]:
        """Return the messages that arrived later than a time in monotonic seconds.

        Latched ones that were forgotten since are among them.
        """
        with self._lock:
            newest = reversed(self._messages)
            found = list(itertools.takewhile(lambda each: each[1].arrived_s > arrived_s, newest))
            latched = _flat(self._latched)
        found.reverse()
        return [*(entry for entry in latched if entry[1].arrived_s > arrived_s), *found]

    def counts(self) -> tuple[float, dict[str, Counter[int]]]:
        """Count the messages of each topic.

        Returns:
            The duration of a part; and messages by topic and part, of which number 0 begins at 0 in
            monotonic seconds.
        """
        part_s = max(MIN_PART_S, self.seconds / MAX_PARTS)
        with self._lock:
            if part_s != self._part_s:
                self._part_s, self._counts = part_s, {}
                for topic, raw in self._messages:
                    self._count(topic, raw, 1)
            return part_s, {topic: own.copy() for topic, own in self._counts.items()}

    def _count(self, topic: str, raw: Raw, change: int) -> None:
        own = self._counts.setdefault(topic, Counter())
        part = int(raw.arrived_s // self._part_s)
        own[part] += change
        if not own[part]:
            del own[part]
            if not own:
                del self._counts[topic]

    def _forget(self, now_s: float) -> None:
        begin_s = now_s - self.seconds
        while self._messages:
            topic, raw = self._messages[0]
            if raw.arrived_s > begin_s:
                if self._bytes <= self.max_bytes:
                    return
                self._full_s = now_s
            self._messages.popleft()
            self.forgotten_s = raw.arrived_s
            self._bytes -= len(raw.cdr) + OVERHEAD
            self._count(topic, raw, -1)
            if self._pin(self._latched, topic, raw):
                self._bound_pinned()

    def _bound_pinned(self) -> None:
        """Forget the oldest of the messages that are kept and too large together."""
        size = sum(len(raw.cdr) for _, raw in self._latched)
        if size <= MAX_PINNED_BYTES:
            return
        for topic, raw in _flat(self._latched)[:-1]:
            self._latched.remove(topic, raw.cdr)
            size -= len(raw.cdr)
            if size <= MAX_PINNED_BYTES:
                break

    def _pin(self, latched: LatchedMessages[Raw], topic: str, raw: Raw) -> bool:
        """Keep a latched message instead of the one of its publisher before it; whether it is."""
        publishers = 1 if has_transforms(topic) else self._depth(topic)
        return latched.put(topic, raw.cdr, raw, publishers)


def _flat(latched: LatchedMessages[Raw]) -> list[Entry]:
    """All latched messages in the order of arrival."""
    return sorted(latched, key=lambda entry: entry[1].arrived_s)
