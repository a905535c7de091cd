"""Remembered messages of live topics as a past to play."""

from __future__ import annotations

import functools
import heapq
import time
from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple

from webviz.sources.inbox import Raw
from webviz.sources.recording import Entry


class WallClock:
    """Times of recording of messages: since 1970, and steady whatever happens to other clocks."""

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


class MemoryChannel(NamedTuple):
    """Messages of one type on one topic."""

    topic: str
    type: str


class MemoryMessage(NamedTuple):
    """One remembered message."""

    topic: str
    cdr: bytes
    stamp_ns: int
    received_ns: int
    number: int
    """In the order of arrival, among those of equal times."""


class MemoryPast:
    """Messages in the order of arrival; see `webviz.sources.bag.past.PastMessages`.

    Args:
        entries: topics and messages, at least one.
        clock: for their times of recording.
    """

    def __init__(self, entries: Sequence[Entry], clock: WallClock) -> None:
        self._entries = entries
        self._clock = clock

    @property
    def start_ns(self) -> int:
        """Time of the first message."""
        return self._stamp(self._entries[0])

    @property
    def end_ns(self) -> int:
        """Time of the last message."""
        return self._stamp(self._entries[-1])

    def messages(
        self, channels: Collection[MemoryChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[MemoryMessage]:
        """Return the messages of some channels by time, both ends included."""
        found = [self._of_topic(channel.topic, start_ns, end_ns) for channel in channels]
        return heapq.merge(*found, key=_order)

    def newest(self, channels: Collection[MemoryChannel], end_ns: int) -> Iterator[MemoryMessage]:
        """Return the messages of some channels until a time, the newest first."""
        found = [self._newest_of(channel.topic, end_ns) for channel in channels]
        return heapq.merge(*found, key=_order, reverse=True)

    def newest_stamps(self, channels: Collection[MemoryChannel], end_ns: int) -> Iterator[int]:
        """Return the times of `newest`."""
        return (message.stamp_ns for message in self.newest(channels, end_ns))

    def has(self, topic: str) -> bool:
        """Return whether there is any message of a topic."""
        return topic in self._by_topic

    def ros_time_ns(self, at_ns: int, is_simulated: bool) -> int:
        """ROS time at a time of recording: that of the last message, and what passed since.

        Args:
            at_ns: the time of recording.
            is_simulated: whether ROS time stands still between messages, as far as is known.
        """
        number = bisect_right(self._entries, at_ns, key=self._stamp) - 1
        entry = self._entries[max(number, 0)]
        passed_ns = 0 if is_simulated else at_ns - self._stamp(entry)
        return entry[1].received_ns + passed_ns

    @functools.cached_property
    def _by_topic(self) -> dict[str, list[tuple[int, Raw]]]:
        """The messages of each topic with their numbers."""
        found: dict[str, list[tuple[int, Raw]]] = {}
        for number, (topic, raw) in enumerate(self._entries):
            found.setdefault(topic, []).append((number, raw))
        return found

    def _of_topic(self, topic: str, start_ns: int, end_ns: int | None) -> Iterator[MemoryMessage]:
        raws = self._by_topic.get(topic, [])
        for number in range(bisect_left(raws, start_ns, key=self._stamp), len(raws)):
            message = self._message(topic, *raws[number])
            if end_ns is not None and message.stamp_ns > end_ns:
                return
            yield message

    def _newest_of(self, topic: str, end_ns: int) -> Iterator[MemoryMessage]:
        raws = self._by_topic.get(topic, [])
        for number in range(bisect_right(raws, end_ns, key=self._stamp) - 1, -1, -1):
            yield self._message(topic, *raws[number])

    def _message(self, topic: str, number: int, raw: Raw) -> MemoryMessage:
        stamp_ns = self._clock.stamp_ns(raw.arrived_s)
        return MemoryMessage(topic, raw.cdr, stamp_ns, raw.received_ns, number)

    def _stamp(self, entry: tuple[object, Raw]) -> int:
        return self._clock.stamp_ns(entry[1].arrived_s)


def _order(message: MemoryMessage) -> tuple[int, int]:
    return message.stamp_ns, message.number
