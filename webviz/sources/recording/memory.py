"""The memory of live topics, as a history."""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Mapping, Sequence
from dataclasses import replace

from webviz.api.declared import Topic
from webviz.sources.bag.log import LEVEL_AT, LOG, MAX_EVENTS, ROSOUT, WARN, event_of
from webviz.sources.history import Recorded, ValidityIntervals
from webviz.sources.inbox import Raw
from webviz.sources.past_state import Event
from webviz.sources.recording.channels import Channels
from webviz.sources.recording.entries_history import EntriesHistory, WallClock
from webviz.sources.recording.recent import Entry, RecentMessages
from webviz.sources.source import Source, Subscription

MEMORY_OFF = (
    "Live topics are not remembered, so there is no past to show. Raise memory.seconds and "
    "memory.megabytes in the config, or start webviz with --memory 60s."
)
NOT_COUNTED: Mapping[str, Sequence[int]] = {}
MAX_HELD_PARTS = 1000
"""Parts of which messages were forgotten meanwhile but are still shown."""


class LiveLog:
    """Keeps what was logged to /rosout; `put` is called from any thread.

    Args:
        clock: for times of recording.
    """

    def __init__(self, clock: WallClock) -> None:
        self._clock = clock
        self._new: deque[Raw] = deque(maxlen=MAX_EVENTS)
        self._events: deque[Event] = deque(maxlen=MAX_EVENTS)
        self._timeline_events: Sequence[Event] = ()

    def put(self, topic: str, raw: Raw) -> None:
        """Take a message of any topic; most are ignored by their topic or level."""
        if topic == ROSOUT and len(raw.cdr) > LEVEL_AT and raw.cdr[LEVEL_AT] >= WARN:
            self._new.append(raw)

    def events(self, start_ns: int) -> Sequence[Event]:
        """Warnings and errors since a time of recording; the same sequence until it changes."""
        events, is_changed = self._events, bool(self._new)
        while self._new:
            raw = self._new.popleft()
            stamp_ns = self._clock.stamp_ns(raw.arrived_s)
            if event := event_of(Recorded(ROSOUT, LOG, raw.cdr, stamp_ns, raw.types)):
                events.append(event[1])
        while events and events[0].at_ns < start_ns:
            events.popleft()
            is_changed = True
        if is_changed:
            self._timeline_events = tuple(events)
        return self._timeline_events


class LiveHistogram:
    """Messages by topic in equal parts of time; one that goes on is counted when it is over.

    Args:
        memory: of the messages.
        clock: for their times of recording.
    """

    def __init__(self, memory: RecentMessages, clock: WallClock) -> None:
        self._memory = memory
        self._clock = clock
        self._old_counts: dict[str, Counter[int]] = {}
        self._old_part_s = 0.0
        self._key: object = None
        self._counts = NOT_COUNTED
        self.span_ns = (0, 0)
        """Times of recording that the counts are of."""

    def hold(self) -> None:
        """Keep the counts of all that is in memory now, until `release`."""
        self._old_part_s, self._old_counts = self._memory.counts()

    def release(self) -> None:
        """Forget what is not in memory."""
        self._old_counts = {}

    def counts(self, now_ns: int) -> Mapping[str, Sequence[int]]:
        """Messages by topic; the same mapping until a part is over.

        Args:
            now_ns: time of recording.
        """
        part_s, by_topic = self._memory.counts() if self._memory.is_on else (1.0, {})
        if self._old_counts and self._old_part_s == part_s:
            for topic, own in self._old_counts.items():
                by_topic[topic] = own | by_topic.get(topic, Counter())  # the greater of each part
        end = int(self._clock.arrived_s(now_ns) // part_s)
        first = min((part for own in by_topic.values() for part in own), default=end)
        first = max(first, end - MAX_HELD_PARTS)
        key = first, end, part_s, len(by_topic)
        if key != self._key:
            self._key = key
            self.span_ns = self._clock.stamp_ns(first * part_s), self._clock.stamp_ns(end * part_s)
            self._counts = {
                topic: [own[part] for part in range(first, end)] for topic, own in by_topic.items()
            }
        return self._counts


class MemoryHistory(EntriesHistory):
    """The memory of a live source, which grows until now.

    What is in it at `hold` stays until `release`, besides the last minutes: the moment that people
    look at is not forgotten. Between two calls of `refresh` it does not change.

    Args:
        live: the source.
    """

    is_growing = True
    names = ()

    def __init__(self, live: Source) -> None:
        super().__init__(live, Channels(live.offers), WallClock())
        self.recent = RecentMessages(self.recorded_channels.latched)
        self.origin_ns = self.clock.now_ns()
        self._histogram = LiveHistogram(self.recent, self.clock)
        self._log = LiveLog(self.clock)
        live.inbox.read_along(lambda: self._log.put)
        self._old_entries: list[Entry] = []
        self._subscriptions: Mapping[str, Subscription] = {}
        self._passed_on: Mapping[str, Subscription] = {}
        """Subscriptions of the live source."""

    def hold(self) -> bool:
        """Keep what is in memory now until `release`; whether that is anything."""
        self._old_entries = self.recent.last(math.inf).whole
        self._entries, self._by_topic, self._validity = [], {}, ValidityIntervals()
        self._histogram.hold()
        self._add(self._old_entries)
        return bool(self._old_entries)

    def release(self) -> None:
        """Forget what is not in memory."""
        self._old_entries, self._entries, self._by_topic = [], [], {}
        self._histogram.release()

    def since(self, at_ns: int) -> list[Entry]:
        """Return the messages that arrived later than a time of recording."""
        return self.recent.after(self.clock.arrived_s(at_ns))

    @property
    def is_held(self) -> bool:
        """Return whether the past is kept that people look back on."""
        return bool(self._old_entries)

    @property
    def held_s(self) -> float:
        """Return the seconds of `entries` while they are held."""
        newest_s = self.recent.newest_s
        if not self._old_entries or newest_s is None:
            return 0.0
        return max(newest_s, self._entries[-1][1].arrived_s) - self._old_entries[0][1].arrived_s

    def entries(self) -> list[Entry]:
        """Return all messages until now, latched ones first, in the order of arrival."""
        if not self._old_entries:
            return self.recent.last(math.inf).whole
        return [*self._entries, *self.recent.after(self._entries[-1][1].arrived_s)]

    # The interface of webviz.sources.history.History

    @property
    def start_ns(self) -> int:
        """Time of the oldest message."""
        if self._old_entries:
            return self._stamp(self._old_entries[0])
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

    def histogram(self, parts: int) -> Mapping[str, Sequence[int]]:
        """`History.histogram`, of parts of at least a second."""
        return self._histogram.counts(self.end_ns)

    @property
    def counted_ns(self) -> tuple[int, int]:
        """`History.counted_ns`."""
        return self._histogram.span_ns

    @property
    def gap_ns(self) -> tuple[int, int] | None:
        """Gap between the newest message that is held and the oldest in memory, if there is one."""
        oldest_s = self.recent.oldest_s
        held_s = self._old_entries[-1][1].arrived_s if self._old_entries else math.inf
        if oldest_s is None or self.recent.forgotten_s <= held_s:
            return None
        return self.clock.stamp_ns(held_s), self.clock.stamp_ns(oldest_s)

    def logged(self) -> Sequence[Event]:
        """`History.logged`, of what was received."""
        return self._log.events(self.start_ns)

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
                topic: subscription
                if topic not in before
                or (is_live and subscription.resubscriptions != before[topic].resubscriptions)
                else replace(subscription, resubscriptions=self._passed_on[topic].resubscriptions)
                for topic, subscription in subscriptions.items()
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
