"""The memory of live topics, as a history."""

from __future__ import annotations

import heapq
import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from webviz.api.declared import Topic
from webviz.data.recordings.latched import STATIC_TF, TF
from webviz.sources.bag.log import LOG, ROSOUT
from webviz.sources.history import HistoryChannel, Recorded, Runs
from webviz.sources.inbox import Raw
from webviz.sources.past_state import Event
from webviz.sources.recording.channels import Channels
from webviz.sources.recording.live_histogram import LiveHistogram
from webviz.sources.recording.live_log import LiveLog
from webviz.sources.recording.recent import Entry, RecentMessages
from webviz.sources.recording.wall_clock import WallClock
from webviz.sources.source import Offer, Source, Subscription

MEMORY_OFF = (
    "Live topics are not remembered, so there is no past to show. Raise memory.seconds and "
    "memory.megabytes in the config, or start webviz with --memory 60s."
)
NOT_REMEMBERED = "none was received before this moment, since only displayed topics are remembered"
"""Why a topic has no message in the past."""
Numbered = tuple[int, Raw]
"""The place of a message in the order of arrival, and the message."""


class MemoryHistory:
    """The memory of a live source, which grows until now.

    What is in it at `hold` stays until `release`, besides the last minutes: the moment that people
    look at is not forgotten. Between two calls of `refresh` it does not change.

    Args:
        live: the source.
    """

    is_growing = True
    names = ()

    def __init__(self, live: Source) -> None:
        self.wake: Callable[[], object] = live.inbox.arrived.set
        self.live = live
        self.recorded_channels = Channels(live.offers)
        self.recent = RecentMessages(self.recorded_channels.latched)
        self.clock = WallClock()
        self.origin_ns = self.clock.now_ns()
        self._histogram = LiveHistogram(self.recent, self.clock)
        self._log = LiveLog(self.clock)
        live.inbox.read_along(lambda: self._log.put)
        self._held: list[Entry] = []
        self._entries: list[Entry] = []
        """Those held and the newest, while it is held."""
        self._by_topic: dict[str, list[Numbered]] = {}
        self._runs = Runs()
        self._subscriptions: Mapping[str, Subscription] = {}
        self._passed_on: Mapping[str, Subscription] = {}
        """Those of the live source."""
        self._offers: tuple[object, object, Mapping[str, Offer]] = None, None, {}

    def hold(self) -> bool:
        """Keep what is in memory now until `release`; whether that is anything."""
        self._held = self.recent.last(math.inf).whole
        self._entries, self._by_topic, self._runs = [], {}, Runs()
        self._histogram.hold()
        self._add(self._held)
        return bool(self._held)

    def release(self) -> None:
        """Forget what is not in memory."""
        self._held, self._entries, self._by_topic = [], [], {}
        self._histogram.release()

    def since(self, at_ns: int) -> list[Entry]:
        """Return the messages that arrived later than a time of recording."""
        return self.recent.after(self.clock.arrived_s(at_ns))

    @property
    def is_held(self) -> bool:
        """Return whether the past is kept that people look back on."""
        return bool(self._held)

    @property
    def held_s(self) -> float:
        """Return the seconds of `entries` while they are held."""
        newest_s = self.recent.newest_s
        if not self._held or newest_s is None:
            return 0.0
        return max(newest_s, self._entries[-1][1].arrived_s) - self._held[0][1].arrived_s

    def entries(self) -> list[Entry]:
        """Return all messages until now, latched ones first, in the order of arrival."""
        if not self._held:
            return self.recent.last(math.inf).whole
        return [*self._entries, *self.recent.after(self._entries[-1][1].arrived_s)]

    # The interface of webviz.sources.history.History

    @property
    def start_ns(self) -> int:
        """Time of the oldest message."""
        if self._held:
            return self._stamp(self._held[0])
        oldest_s = self.recent.oldest_s
        return self.end_ns if oldest_s is None else self.clock.stamp_ns(oldest_s)

    @property
    def last_ns(self) -> int:
        """Time of the newest message, as of the last `refresh` or `hold`."""
        return self._stamp(self._entries[-1]) if self._entries else self.end_ns

    @property
    def end_ns(self) -> int:
        """Now."""
        return self.clock.now_ns()

    def refresh(self) -> bool:
        """`History.refresh`."""
        newest_s = self.recent.newest_s
        known_s = self._entries[-1][1].arrived_s
        if newest_s is None or newest_s <= known_s:
            return False
        self._add(self.recent.after(known_s))
        return True

    def channels(self, subscriptions: Mapping[str, Subscription]) -> Sequence[HistoryChannel]:
        """`History.channels`: those that are remembered as the type of the subscription."""
        found = (each for topic in subscriptions for each in self.channels_of(topic))
        return [each for each in found if each.type == subscriptions[each.topic].type]

    def channels_of(self, topic: str) -> Sequence[HistoryChannel]:
        """`History.channels_of`."""
        channel = self.recorded_channels.find(topic)
        return [HistoryChannel(topic, channel.type)] if channel else []

    def messages(
        self, channels: Collection[HistoryChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """`History.messages`."""
        found = [self._of_channel(each, start_ns, end_ns) for each in channels]
        return map(_recorded, heapq.merge(*found))

    def newest(self, channels: Collection[HistoryChannel], end_ns: int) -> Iterator[Recorded]:
        """`History.newest`."""
        found = [self._newest_of(each, end_ns) for each in channels]
        return map(_recorded, heapq.merge(*found, reverse=True))

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

    def runs(self) -> Runs:
        """`History.runs`."""
        return self._runs

    def time(self) -> MemoryTime:
        """`History.time`."""
        return MemoryTime(self._entries, self.clock, self.live)

    def offers(self, subscriptions: Mapping[str, Subscription]) -> Mapping[str, Offer]:
        """Those of the live source, which say why a topic may have no message."""
        live = self.live.offers()
        known, for_, offers = self._offers
        if known is not live or for_ is not subscriptions:
            offers = {
                topic: replace(offer, begins=NOT_REMEMBERED) if topic in subscriptions else offer
                for topic, offer in live.items()
            }
            self._offers = live, subscriptions, offers
        return offers

    def warnings(self, subscriptions: Mapping[str, Subscription]) -> Sequence[str]:
        """None."""
        return ()

    def histogram(self, parts: int) -> Mapping[str, Sequence[int]]:
        """`History.histogram`, of parts of at least a second."""
        return self._histogram.counts(self.end_ns)

    @property
    def counted_ns(self) -> tuple[int, int]:
        """`History.counted_ns`."""
        return self._histogram.span_ns

    @property
    def gap_ns(self) -> tuple[int, int] | None:
        """From the newest message that is held to the oldest in memory, if it is older."""
        oldest_s = self.recent.oldest_s
        held_s = self._held[-1][1].arrived_s if self._held else math.inf
        if oldest_s is None or self.recent.forgotten_s <= held_s:
            return None
        return self.clock.stamp_ns(held_s), self.clock.stamp_ns(oldest_s)

    def logged(self) -> Sequence[Event]:
        """`History.logged`, of what was received."""
        return self._log.events(self.start_ns)

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic; raises ValueError."""
        return self.live.resolve(topic)

    def close(self) -> None:
        """Do nothing."""

    def subscribe(self, subscriptions: Mapping[str, Subscription], *, is_live: bool) -> None:
        """Make the subscriptions of the live source these, and the log of all nodes.

        Args:
            subscriptions: by topic; the same object until they change.
            is_live: whether it may be asked to repeat what is latched: while the past is shown, the
                memory has that.
        """
        if subscriptions is not self._subscriptions:
            before, self._subscriptions = self._subscriptions, subscriptions
            self._passed_on = {
                topic: wanted
                if topic not in before or (is_live and wanted.asked != before[topic].asked)
                else replace(wanted, asked=self._passed_on[topic].asked)
                for topic, wanted in subscriptions.items()
            }
        self.live.want(self._with_log(self._passed_on))

    def _with_log(self, subscriptions: Mapping[str, Subscription]) -> Mapping[str, Subscription]:
        """Return these and the log of all nodes, if the memory needs it and no other reads it."""
        offer = self.live.offers().get(ROSOUT)
        is_offered = offer is not None and any(each.type == LOG for each in offer.publishers)
        if not self.recent.is_on or ROSOUT in subscriptions or not is_offered:
            return subscriptions
        # What was logged before is not of the time at which it would be received.
        return {**subscriptions, ROSOUT: Subscription(LOG, Topic(ROSOUT, durability="volatile"))}

    def _add(self, entries: Sequence[Entry]) -> None:
        """Add messages that arrived later than all others."""
        for number, (topic, raw) in enumerate(entries, len(self._entries)):
            self._by_topic.setdefault(topic, []).append((number, raw))
            channel = self.recorded_channels.find(topic)
            if channel is not None and channel.type == TF:
                is_static = topic.endswith(STATIC_TF)
                self._runs.read(raw.cdr, self.clock.stamp_ns(raw.arrived_s), is_static)
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
