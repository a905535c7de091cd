"""Past messages without which a time of a history cannot be shown."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from webviz.api.lookback import Lookback
from webviz.data.messages import MessageError, decode, peek_header
from webviz.data.recordings.latched import TF
from webviz.sources.history.history import CLOCK, FOLLOWED, History, HistoryChannel, Recorded
from webviz.sources.history.intervals import GAP_NS, ValidityIntervals, links_in
from webviz.sources.source import Subscription

RECENT_NS = 15_000_000_000
"""Topics are read together if only messages that are younger are needed."""
BEFORE_NS, AFTER_NS = 10_000_000_000, 3_000_000_000
"""An older message is placed with the transforms of this time around it."""
AROUND_NS = 1_000_000_000
"""Time in ns before and after the last transform of a frame in which others are read, which place
it."""
NEAR_ENDS_NS = 50_000_000
"""Ends of transforms that are closer to each other count as one."""
MAX_OLD = 100
"""Older messages of a topic with transforms of their own; of more, all transforms since."""


class NeededMessages:
    """Finds the messages that the state at a time depends on.

    Messages that wait for transforms are drawn once these come. So the newest ones that are drawn
    may lie far back: where the transforms of a frame above theirs have ended.

    Args:
        history: all messages.
        channels: those to read.
        subscriptions: by topic, with their lookbacks.
        at_ns: the time of recording.
    """

    def __init__(
        self,
        history: History,
        channels: Collection[HistoryChannel],
        subscriptions: Mapping[str, Subscription],
        at_ns: int,
    ) -> None:
        self._history = history
        self._subscriptions = subscriptions
        self._at_ns = at_ns
        self._validity: ValidityIntervals = history.validity()
        self._channels: dict[str, list[HistoryChannel]] = {}
        for channel in channels:
            self._channels.setdefault(channel.topic, []).append(channel)
        self._starts: dict[str, int] = {}
        self._whole_from: dict[str, int] = {}
        """Time from which on all messages of a topic are needed, by topic; of those before, the
        following."""
        self._chosen: dict[str, set[int]] = {}
        """Stamps by topic."""
        self._ends: dict[str, Sequence[int]] = {}
        """Times when the frames above had their last transforms, by frame."""

    def messages(self) -> Iterator[Recorded]:
        """Return the messages by time of recording, those at the time included."""
        recent_ns = max(self._at_ns - RECENT_NS, self._history.start_ns)
        follow: list[HistoryChannel] = []
        together: list[HistoryChannel] = []
        alone: list[Iterator[Recorded]] = []
        ended_ns = self._validity.ended_ns(self._at_ns - RECENT_NS)
        placed = [(stamp_ns - AROUND_NS, stamp_ns + AROUND_NS) for stamp_ns in ended_ns]
        timed: list[tuple[int, int]] = []
        for topic, channels in self._channels.items():
            if channels[0].type in FOLLOWED and not self._is_whole(topic):
                follow += channels
                continue
            start_ns = self._start_ns(topic)
            if start_ns > recent_ns:
                together += channels
                continue
            alone.append(self._read(channels, start_ns, self._at_ns))
            spans = self._spans(channels, start_ns, recent_ns)
            timed += spans
            if (subscription := self._subscriptions.get(topic)) and subscription.is_placed:
                placed += spans
        clocks = [channel for channel in follow if channel.type == CLOCK]
        moving = [channel for channel in follow if channel.type != CLOCK]
        last = [(recent_ns, self._at_ns)]
        return heapq.merge(
            self._within(clocks, [*timed, *last]),
            self._within(moving, [*placed, *last]),
            self._young(together, recent_ns),
            *alone,
            key=lambda recorded: recorded.stamp_ns,
        )

    def _is_whole(self, topic: str) -> bool:
        subscription = self._subscriptions.get(topic)
        return subscription is not None and Lookback() in subscription.lookbacks

    def _young(self, channels: Sequence[HistoryChannel], recent_ns: int) -> Iterator[Recorded]:
        """Yield the messages of several topics, each from its start on."""
        for recorded in self._history.messages(channels, recent_ns, self._at_ns):
            if self._is_needed(recorded):
                yield recorded

    def _read(
        self, channels: Sequence[HistoryChannel], start_ns: int, end_ns: int
    ) -> Iterator[Recorded]:
        """Return the messages of a topic that are needed."""
        return filter(self._is_needed, self._history.messages(channels, start_ns, end_ns))

    def _is_needed(self, recorded: Recorded) -> bool:
        topic, stamp_ns = recorded.topic, recorded.stamp_ns
        return stamp_ns >= self._whole_from[topic] or stamp_ns in self._chosen[topic]

    def _within(
        self, channels: Sequence[HistoryChannel], spans: Sequence[tuple[int, int]]
    ) -> Iterator[Recorded]:
        """Yield the messages of channels within some spans of time, each once."""
        until_ns = self._history.start_ns - 1
        for start_ns, end_ns in sorted(spans) if channels else ():
            if end_ns > until_ns:
                start_ns = max(start_ns, until_ns + 1)
                until_ns = min(end_ns, self._at_ns)
                yield from self._history.messages(channels, start_ns, until_ns)

    def _spans(
        self, channels: Sequence[HistoryChannel], start_ns: int, recent_ns: int
    ) -> Sequence[tuple[int, int]]:
        """Return when the transforms and the clock are needed for the older messages of a topic."""
        older = self._read(channels, start_ns, recent_ns)
        stamps = [each.stamp_ns for each in itertools.islice(older, MAX_OLD + 1)]
        if len(stamps) > MAX_OLD:
            return [(start_ns - BEFORE_NS, recent_ns)]
        return [(stamp_ns - BEFORE_NS, stamp_ns + AFTER_NS) for stamp_ns in stamps]

    def _start_ns(self, topic: str) -> int:
        """Return the first time at which a topic is needed."""
        if topic not in self._starts:
            self._starts[topic] = self._history.start_ns  # if inputs refer to each other
            subscription, channels = self._subscriptions[topic], self._channels[topic]
            plain = [each for each in subscription.lookbacks if each.chooses is None]
            starts = [self._start_of(channels, lookback, subscription) for lookback in plain]
            self._whole_from[topic] = min(starts, default=self._at_ns + 1)
            chosen = self._chosen[topic] = {
                stamp_ns
                for lookback in subscription.lookbacks
                for stamp_ns in self._chosen_by(channels, lookback, subscription, self._at_ns)
            }
            if subscription.is_placed and self._whole_from[topic] > self._history.start_ns:
                for end_ns in self._ends_above(channels):
                    chosen.update(self._placed_until(channels, subscription, end_ns))
            self._starts[topic] = min([self._whole_from[topic], *chosen])
        return self._starts[topic]

    def _start_of(
        self, channels: Sequence[HistoryChannel], lookback: Lookback, subscription: Subscription
    ) -> int:
        limit_ns = self._limit_ns(lookback)
        if not (lookback.count or lookback.starts_over):
            return limit_ns
        newest = self._newest(channels, lookback, subscription, limit_ns, self._at_ns)
        return min((recorded.stamp_ns for recorded in newest), default=self._at_ns + 1)

    def _chosen_by(
        self,
        channels: Sequence[HistoryChannel],
        lookback: Lookback,
        subscription: Subscription,
        until_ns: int,
    ) -> Iterator[int]:
        """Yield the stamps of the messages until a time that a lookback chooses."""
        if lookback.chooses is None:
            return
        stamps: list[int] = []
        limit_ns = self._limit_ns(lookback)
        newest = self._newest(channels, lookback, subscription, limit_ns, until_ns)
        for number in lookback.chooses(_decoded(newest, subscription.type, stamps)):
            yield stamps[number]

    def _placed_until(
        self, channels: Sequence[HistoryChannel], subscription: Subscription, end_ns: int
    ) -> Iterator[int]:
        """Yield the stamps of the messages that were drawn when transforms ended.

        Those that came a little later may have stamps before the end.
        """
        until_ns = min(end_ns + AROUND_NS, self._at_ns)
        for lookback in subscription.lookbacks:
            limit_ns = self._limit_ns(lookback)
            before = 0
            for stamp_ns in self._history.newest_stamps(channels, until_ns):
                before += stamp_ns <= end_ns
                if stamp_ns < limit_ns or before > lookback.count:
                    break
                yield stamp_ns
            yield from self._chosen_by(channels, lookback, subscription, end_ns)

    def _ends_above(self, channels: Sequence[HistoryChannel]) -> Sequence[int]:
        """Return when frames above that of the newest message had their last transforms."""
        newest = next(self._history.newest(channels, self._at_ns), None)
        try:
            header = newest and peek_header(newest.type, newest.cdr, newest.types)
        except MessageError:
            header = None
        if not header:
            return ()
        frame = header[0].removeprefix("/")
        if frame not in self._ends:
            above = self._validity.above(frame, self._at_ns)
            ends = {end_ns for end_ns in above.values() if end_ns is not None}
            ends.update(self._last({child for child, end_ns in above.items() if end_ns is None}))
            stamps: list[int] = []
            for end_ns in sorted(ends, reverse=True):
                if not stamps or stamps[-1] - end_ns > NEAR_ENDS_NS:
                    stamps.append(end_ns)
            self._ends[frame] = stamps
        return self._ends[frame]

    def _last(self, children: set[str]) -> Iterator[int]:
        """Yield when some frames had their last transforms, less than `GAP_NS` ago."""
        moving = [c for own in self._channels.values() for c in own if c.type == TF]
        for recorded in self._history.newest(moving, self._at_ns) if children else ():
            if recorded.stamp_ns < self._at_ns - GAP_NS:
                return
            reached = children.intersection(child for _, child in links_in(recorded.cdr))
            if reached:
                yield recorded.stamp_ns
                children -= reached
            if not children:
                return

    def _limit_ns(self, lookback: Lookback) -> int:
        """Return the first time at which messages may count."""
        limit_ns = self._history.start_ns
        if lookback.seconds:
            limit_ns = max(limit_ns, self._at_ns - round(min(lookback.seconds, 1e9) * 1e9))
        if lookback.since:
            is_read = lookback.since in self._channels
            since_ns = self._start_ns(lookback.since) if is_read else self._at_ns + 1
            limit_ns = max(limit_ns, since_ns)
        return limit_ns

    def _newest(
        self,
        channels: Collection[HistoryChannel],
        lookback: Lookback,
        subscription: Subscription,
        limit_ns: int,
        until_ns: int,
    ) -> Iterator[Recorded]:
        """Yield the messages until a time that a lookback leaves, the newest first."""
        for number, recorded in enumerate(self._history.newest(channels, until_ns), 1):
            if recorded.stamp_ns < limit_ns:
                return
            yield recorded
            if number == lookback.count or _starts_over(lookback, recorded, subscription):
                return


def _decoded(newest: Iterator[Recorded], type_name: str, stamps: list[int]) -> Iterator[Any]:
    """Messages, of which those that cannot be decoded are skipped; the others' stamps are noted."""
    for recorded in newest:
        try:
            message = decode(type_name, recorded.cdr, recorded.types)
        except MessageError:
            continue
        stamps.append(recorded.stamp_ns)
        yield message


def _starts_over(lookback: Lookback, recorded: Recorded, subscription: Subscription) -> bool:
    if lookback.starts_over is None:
        return False
    try:
        message = decode(subscription.type, recorded.cdr, recorded.types)
        return lookback.starts_over(message, subscription.type)
    except MessageError:
        return False
