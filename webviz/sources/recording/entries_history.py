"""Messages that were received, as a history."""

from __future__ import annotations

import heapq
import time
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from webviz.data.recordings.latched import STATIC_TF, TF
from webviz.sources.history import HistoryChannel, Recorded, ValidityIntervals
from webviz.sources.inbox import Raw
from webviz.sources.recording.channels import Channels
from webviz.sources.recording.recent import Entry
from webviz.sources.source import Offer, Source, Subscription

NOT_REMEMBERED = (
    "memory has none up to this moment; it holds displayed topics only, and drops the oldest "
    "messages first, large ones before others"
)
"""Reason why a topic has no message in the past."""
Numbered = tuple[int, Raw]
"""The place of a message in the order of arrival, and the message."""


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


class EntriesHistory:
    """Base of the histories of received messages.

    Args:
        live: the source that received them.
        recorded_channels: of their topics.
        clock: for their times of recording.
    """

    def __init__(self, live: Source, recorded_channels: Channels, clock: WallClock) -> None:
        self.wake: Callable[[], object] = live.inbox.arrived.set
        self.live = live
        self.recorded_channels = recorded_channels
        self.clock = clock
        self._entries: list[Entry] = []
        """Entries in the order of arrival."""
        self._by_topic: dict[str, list[Numbered]] = {}
        self._validity = ValidityIntervals()
        self._offers: tuple[object, object, Mapping[str, Offer]] = None, None, {}

    def channels(self, subscriptions: Mapping[str, Subscription]) -> Sequence[HistoryChannel]:
        """`History.channels`: those that are remembered as the type of the subscription."""
        candidates = (each for topic in subscriptions for each in self.channels_of(topic))
        return [each for each in candidates if each.type == subscriptions[each.topic].type]

    def channels_of(self, topic: str) -> Sequence[HistoryChannel]:
        """`History.channels_of`."""
        channel = self.recorded_channels.find(topic)
        return [HistoryChannel(topic, channel.type)] if channel else []

    def messages(
        self, channels: Collection[HistoryChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """`History.messages`."""
        streams = [self._of_channel(each, start_ns, end_ns) for each in channels]
        return map(_recorded, heapq.merge(*streams))

    def newest(self, channels: Collection[HistoryChannel], end_ns: int) -> Iterator[Recorded]:
        """`History.newest`."""
        streams = [self._newest_of(each, end_ns) for each in channels]
        return map(_recorded, heapq.merge(*streams, reverse=True))

    def newest_stamps(self, channels: Collection[HistoryChannel], end_ns: int) -> Iterator[int]:
        """`History.newest_stamps`."""
        return (recorded.stamp_ns for recorded in self.newest(channels, end_ns))

    def first_ns(self, channel: HistoryChannel) -> int | None:
        """`History.first_ns`."""
        own = self._by_topic.get(channel.topic)
        return self._stamp(own[0]) if own else None

    def latched(self, channel: HistoryChannel, is_wanted: bool) -> int:
        """`History.latched`: one of each publisher."""
        return self.recorded_channels.latched(channel.topic)

    def validity(self) -> ValidityIntervals:
        """`History.validity`."""
        return self._validity

    def time(self) -> MemoryTime:
        """`History.time`."""
        return MemoryTime(self._entries, self.clock, self.live)

    def offers(self, subscriptions: Mapping[str, Subscription]) -> Mapping[str, Offer]:
        """Return the offers of the live source, which say why a topic may have no message."""
        live = self.live.offers()
        former, for_, offers = self._offers
        if former is not live or for_ is not subscriptions:
            offers = {
                topic: replace(offer, begins=NOT_REMEMBERED) if topic in subscriptions else offer
                for topic, offer in live.items()
            }
            self._offers = live, subscriptions, offers
        return offers

    def warnings(self, subscriptions: Mapping[str, Subscription]) -> Sequence[str]:
        """None."""
        return ()

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic; raises ValueError."""
        return self.live.resolve(topic)

    def close(self) -> None:
        """Do nothing."""

    # Internal

    def _add(self, entries: Sequence[Entry]) -> None:
        """Add messages that arrived later than all others."""
        for number, (topic, raw) in enumerate(entries, len(self._entries)):
            self._by_topic.setdefault(topic, []).append((number, raw))
            channel = self.recorded_channels.find(topic)
            if channel is not None and channel.type == TF:
                is_static = topic.endswith(STATIC_TF)
                self._validity.read(raw.cdr, self.clock.stamp_ns(raw.arrived_s), is_static)
        self._entries += entries

    def _of_channel(
        self, channel: HistoryChannel, start_ns: int, end_ns: int | None
    ) -> Iterator[tuple[int, int, Recorded]]:
        own = self._by_topic.get(channel.topic, [])
        for place in range(bisect_left(own, start_ns, key=self._stamp), len(own)):
            stamp_ns = self._stamp(own[place])
            if end_ns is not None and stamp_ns > end_ns:
                return
            yield self._entry(channel, stamp_ns, *own[place])

    def _newest_of(
        self, channel: HistoryChannel, end_ns: int
    ) -> Iterator[tuple[int, int, Recorded]]:
        own = self._by_topic.get(channel.topic, [])
        for place in range(bisect_right(own, end_ns, key=self._stamp) - 1, -1, -1):
            yield self._entry(channel, self._stamp(own[place]), *own[place])

    @staticmethod
    def _entry(
        channel: HistoryChannel, stamp_ns: int, number: int, raw: Raw
    ) -> tuple[int, int, Recorded]:
        """Return a message, sorted by time and then by arrival."""
        return stamp_ns, number, Recorded(*channel, raw.cdr, stamp_ns, raw.types)

    def _stamp(self, entry: tuple[object, Raw]) -> int:
        return self.clock.stamp_ns(entry[1].arrived_s)


class MemoryTime:
    """ROS time of remembered messages: that of the last one, and what passed since.

    Args:
        entries: all messages, which may grow.
        clock: for their times of recording.
        live: knows whether ROS time is simulated, and so stands still between messages.
    """

    def __init__(self, entries: Sequence[Entry], clock: WallClock, live: Source) -> None:
        self._entries = entries
        self._clock = clock
        self._live = live

    def seek(self, at_ns: int) -> None:
        """Do nothing: every message knows when it was received."""

    def take(self, recorded: Recorded) -> None:
        """Do nothing."""

    def at(self, recorded_ns: int) -> int:
        """`RecordedTime.at`."""
        number = bisect_right(self._entries, recorded_ns, key=self._stamp) - 1
        entry = self._entries[max(number, 0)]
        is_simulated = self._live.clock_messages() is not None
        passed_ns = 0 if is_simulated else recorded_ns - self._stamp(entry)
        return entry[1].received_ns + passed_ns

    def _stamp(self, entry: Entry) -> int:
        return self._clock.stamp_ns(entry[1].arrived_s)


def _recorded(entry: tuple[int, int, Recorded]) -> Recorded:
    return entry[2]
