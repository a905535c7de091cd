"""The last seconds of what arrived, in memory."""

from __future__ import annotations

import heapq
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
"""Limit in bytes of all messages that are kept beyond the bounds; the newest is, however large."""

LARGE_BYTES = 64 << 10
"""Size of a message from which it belongs to the large ones: clouds, images and maps."""
SMALL_SHARE = 0.25
"""Share of the memory that large messages leave to the small ones."""

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

    Large messages have a share of their own, so that a cloud of 16 MB does not leave a past of ten
    seconds without transforms, scans and poses: those of the whole time are kept besides.

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
        self._small = _Queue()
        self._large = _Queue()
        self._latched = LatchedMessages[Raw]()
        self._full_s: float | None = None
        self._part_s = MIN_PART_S
        self._counts: dict[str, Counter[int]] = {}
        """Messages by topic and part, which is the number of parts since time began."""
        self.forgotten_s = -math.inf
        """Arrival of the newest message that was forgotten in monotonic seconds; large ones count
        only if there are no small ones."""
        self.seconds = seconds
        self.max_bytes = max_bytes

    @property
    def is_on(self) -> bool:
        """Return whether anything is kept."""
        return self.seconds > 0 and self.max_bytes > 0

    def put(self, topic: str, raw: Raw) -> None:
        """Add a message, and forget the oldest that do not fit any more."""
        with self._lock:
            queue = self._large if len(raw.cdr) >= LARGE_BYTES else self._small
            queue.put(topic, raw)
            self._count(topic, raw, 1)
            self._forget(raw.arrived_s)

    def size(self) -> tuple[float, int]:
        """Return the seconds since the oldest message, and the bytes of all."""
        now_s = time.monotonic()
        with self._lock:
            self._forget(now_s)
            latched = sum(len(raw.cdr) for _, raw in self._latched)
            oldest_s = min((q.oldest_s for q in self._queues if q), default=now_s)
            return now_s - oldest_s, self._bytes + latched

    @property
    def oldest_s(self) -> float | None:
        """Return when the oldest message arrived, in monotonic seconds; None without any."""
        with self._lock:
            return min((queue.oldest_s for queue in self._queues if queue), default=None)

    @property
    def newest_s(self) -> float | None:
        """Return when the newest message arrived, in monotonic seconds; None without any."""
        with self._lock:
            return max((queue.newest_s for queue in self._queues if queue), default=None)

    @property
    def is_full(self) -> bool:
        """Return whether messages younger than `seconds` were forgotten for their size."""
        full_s = self._full_s
        return full_s is not None and time.monotonic() - full_s < self.seconds

    def cut(self) -> tuple[tuple[str, ...], float] | None:
        """Return the large topics that reach back less than the small ones, and for how long.

        None while all messages of the wanted time fit, or the small ones are cut as well.
        """
        now_s = time.monotonic()
        with self._lock:
            if not (self._large and self._small and self.is_full):
                return None
            seconds = now_s - self._large.oldest_s
            if now_s - self._small.oldest_s < seconds + 1.0:
                return None
            return tuple(sorted({topic for topic, _ in self._large.entries})), seconds

    def pinned(self) -> tuple[str, ...]:
        """Return the topics of which messages are kept although they are old."""
        with self._lock:
            return self._latched.topics()

    def last(self, seconds: float) -> Remembered:
        """Return the messages of the last seconds, as far as they are remembered."""
        begin_s = time.monotonic() - seconds
        with self._lock:
            messages = self._merged()
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
            streams = [queue.after(arrived_s) for queue in self._queues]
            latched = _flat(self._latched)
        newer = (entry for entry in latched if entry[1].arrived_s > arrived_s)
        return [*newer, *heapq.merge(*streams, key=_arrival)]

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
                for topic, raw in self._merged():
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

    @property
    def _queues(self) -> tuple[_Queue, _Queue]:
        return self._small, self._large

    @property
    def _bytes(self) -> int:
        return self._small.bytes + self._large.bytes

    def _merged(self) -> list[Entry]:
        return list(heapq.merge(*(queue.entries for queue in self._queues), key=_arrival))

    def _forget(self, now_s: float) -> None:
        begin_s = now_s - self.seconds
        for queue in self._queues:
            while queue and queue.oldest_s <= begin_s:
                self._forget_oldest(queue)
        while self._bytes > self.max_bytes and self._bytes:
            self._full_s = now_s
            is_share_kept = self._small.bytes <= SMALL_SHARE * self.max_bytes
            self._forget_oldest(self._large if is_share_kept and self._large else self._small)

    def _forget_oldest(self, queue: _Queue) -> None:
        topic, raw = queue.pop()
        if queue is self._small or not self._small:
            self.forgotten_s = raw.arrived_s
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


class _Queue:
    """Messages in the order of arrival, and their bytes."""

    def __init__(self) -> None:
        self.entries: deque[Entry] = deque()
        self.bytes = 0

    def __bool__(self) -> bool:
        """Return whether there are any."""
        return bool(self.entries)

    @property
    def oldest_s(self) -> float:
        """Arrival of the first in monotonic seconds."""
        return self.entries[0][1].arrived_s

    @property
    def newest_s(self) -> float:
        """Arrival of the last in monotonic seconds."""
        return self.entries[-1][1].arrived_s

    def put(self, topic: str, raw: Raw) -> None:
        """Add a message."""
        self.entries.append((topic, raw))
        self.bytes += len(raw.cdr) + OVERHEAD

    def pop(self) -> Entry:
        """Remove the oldest message, and return it."""
        topic, raw = self.entries.popleft()
        self.bytes -= len(raw.cdr) + OVERHEAD
        return topic, raw

    def after(self, arrived_s: float) -> list[Entry]:
        """Return the messages that arrived later than a time in monotonic seconds."""
        newest = reversed(self.entries)
        entries = list(itertools.takewhile(lambda each: each[1].arrived_s > arrived_s, newest))
        entries.reverse()
        return entries


def _arrival(entry: Entry) -> float:
    return entry[1].arrived_s


def _flat(latched: LatchedMessages[Raw]) -> list[Entry]:
    """All latched messages in the order of arrival."""
    return sorted(latched, key=lambda entry: entry[1].arrived_s)
