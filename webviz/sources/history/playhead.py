"""A position in a history, and delivery of what was recorded until then."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from webviz.api.lookback import Lookback
from webviz.data.recordings.latched import TF
from webviz.sources.history.history import FOLLOWED, History, HistoryChannel, Recorded
from webviz.sources.history.needed import NeededMessages
from webviz.sources.inbox import Earlier, Raw
from webviz.sources.source import Subscription

MAX_BATCH = 500
"""Messages per call of `play`, so that no queue of the inbox overflows."""
MAX_BATCH_BYTES = 32 << 20
STEP_NS, LONG_STEP_NS = 100_000_000, 2_000_000_000
"""Recording time between two turns of a frame loop that draws nothing: longer while it is far from
its destination, but much shorter than the history of transforms."""
LAST = 100
"""Messages of a topic whose times are known."""


class EarlierMessages:
    """Knows the last messages of topics until a position, until their next one is delivered.

    Args:
        history: all messages.
    """

    def __init__(self, history: History) -> None:
        self._history = history
        self._earlier_stamps: dict[str, Earlier] = {}

    def look(self, channels: Collection[HistoryChannel], at_ns: int, *, is_new: bool) -> None:
        """Look up the last messages of channels until a time of recording.

        Args:
            channels: one of a topic; those of transforms and of the clock are ignored.
            at_ns: the time.
            is_new: whether this replaces what is known of topics.
        """
        if self._history.is_growing:
            return
        for channel in channels:
            if channel.type in FOLLOWED or (channel.topic in self._earlier_stamps and not is_new):
                continue
            newest = self._history.newest_stamps([channel], at_ns)
            stamps = list(itertools.islice(newest, LAST))
            if stamps:
                first_ns = self._history.first_ns(channel)
                first_ns = stamps[-1] if first_ns is None else first_ns
                self._earlier_stamps[channel.topic] = Earlier(stamps, first_ns)

    def clear(self) -> None:
        """Forget what no message was delivered for."""
        self._earlier_stamps.clear()

    def take(self, recorded: Recorded) -> Earlier | None:
        """Return what came before a message, once it is the newest or follows that."""
        earlier, stamp_ns = self._earlier_stamps.get(recorded.topic), recorded.stamp_ns
        if earlier is None or stamp_ns < earlier.recorded_ns[0]:
            return None
        del self._earlier_stamps[recorded.topic]
        # Others of the same time are delivered with it.
        before = [each for each in earlier.recorded_ns if each < stamp_ns]
        return replace(earlier, recorded_ns=before)


class Playhead:
    """Delivers the messages of a history that are subscribed to, in order.

    Args:
        history: of the messages.
        deliver: called with the topic and each message.
    """

    def __init__(self, history: History, deliver: Callable[[str, Raw], object]) -> None:
        self.history = history
        self.position_ns = history.start_ns - 1
        """Everything recorded until then was delivered."""
        self._deliver = deliver
        self._time = history.time()
        self._subscriptions: Mapping[str, Subscription] = {}
        self._types: dict[str, str] = {}
        """Types of the subscriptions, by topic."""
        self._types_of_seek: dict[str, str] = {}
        """Types of subscriptions whose past the last seek delivers, by topic."""
        self._earlier = EarlierMessages(history)
        self._next: Recorded | None = None
        self._upcoming: Iterator[Recorded] = iter(())

    def now_ns(self) -> int:
        """Return ROS time at the position; it is known also where it is 0 or less."""
        return max(self._time.at(self.position_ns), 1)

    @property
    def next_ns(self) -> int:
        """Time of the next message to deliver; that of the end after the last one."""
        return self.history.last_ns if self._next is None else self._next.stamp_ns

    def subscribe(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these; another object after a change.

        A new one gets what it would hold if it had been there from the start; one that is asked
        anew, what publishers repeat. Neither does while the seek before delivers all of that.
        """
        if subscriptions is self._subscriptions:
            return
        before, self._subscriptions = self._subscriptions, subscriptions
        types_before, self._types = self._types, _types(subscriptions)
        delivered, self._types_of_seek = self._types_of_seek, {}
        for topic, subscription in subscriptions.items():
            is_new = types_before.get(topic) != subscription.type
            is_repeated = is_new or subscription.resubscriptions > before[topic].resubscriptions
            if is_repeated and delivered.get(topic) != subscription.type:
                self._catch_up(topic, subscription, is_new)
        if types_before != self._types:
            self._read_on()

    def play(self, until_ns: int) -> None:
        """Deliver everything recorded until a time, or a part of it that an inbox can hold.

        `position_ns` says how far that is; the next call continues.

        Raises:
            BagError: a file can no longer be read; so do the other methods.
        """
        self._take_in_more()
        count = size = 0
        while self._next is not None and self._next.stamp_ns <= until_ns:
            # Messages of one stamp arrive together. Stamps in a file may be slightly out of order.
            is_later = self._next.stamp_ns > self.position_ns
            if is_later and (count >= MAX_BATCH or size >= MAX_BATCH_BYTES):
                return
            self.position_ns = max(self.position_ns, self._next.stamp_ns)
            self._arrive(self._next)
            count, size = count + 1, size + len(self._next.cdr)
            self._next = next(self._upcoming, None)
        self.position_ns = max(self.position_ns, until_ns)

    def play_step(self, until_ns: int) -> None:
        """Play a short step towards a time, or up to the next message if that is later."""
        self._take_in_more()
        next_ns = until_ns if self._next is None else self._next.stamp_ns
        left_ns = until_ns - self.position_ns
        step_ns = min(max(left_ns // 8, STEP_NS), LONG_STEP_NS)
        self.play(min(until_ns, max(next_ns, self.position_ns + step_ns)))

    def seek(self, at_ns: int) -> None:
        """Go to a position from which playing to a time delivers all that is to be seen there."""
        history = self.history
        history.refresh()
        channels = history.channels(self._subscriptions)
        needed = NeededMessages(history, channels, self._subscriptions, at_ns).messages()
        self._upcoming = itertools.chain(needed, history.messages(channels, at_ns + 1))
        self._next = next(self._upcoming, None)
        first_ns = at_ns if self._next is None else self._next.stamp_ns
        self.position_ns = min(first_ns, at_ns) - 1
        self._time.seek(self.position_ns)
        self._earlier.clear()
        self._earlier.look(self._subscribed(), at_ns, is_new=True)
        self._types_of_seek = dict(self._types)

    def neighbour(self, topic: str, is_forward: bool) -> int | None:
        """Return the time of the next or previous message of a topic, seen from the position.

        Args:
            topic: full name; "" is every subscribed topic but those of transforms and time.
            is_forward: the next message later than the position, or else the last one earlier.

        Returns:
            None if there is no such message.
        """
        history = self.history
        channels = history.channels_of(topic) if topic else self._displayed()
        if is_forward:
            neighbour = next(history.messages(channels, self.position_ns + 1), None)
        else:
            before_ns = min(self.position_ns, history.last_ns) - 1
            neighbour = next(history.newest(channels, before_ns), None)
        return None if neighbour is None else neighbour.stamp_ns

    def _subscribed(self) -> Sequence[HistoryChannel]:
        """Return the channels of subscriptions, without /clock unless it is one of them."""
        channels = self.history.channels(self._subscriptions)
        return [channel for channel in channels if channel.topic in self._subscriptions]

    def _displayed(self) -> Sequence[HistoryChannel]:
        return [channel for channel in self._subscribed() if channel.type not in FOLLOWED]

    def _take_in_more(self) -> None:
        """Read what was recorded since a history was read to its end."""
        if self._next is None and self.history.refresh():
            self._read_on()

    def _read_on(self) -> None:
        """Deliver the messages of the subscriptions from the position on."""
        channels = self.history.channels(self._subscriptions)
        self._upcoming = self.history.messages(channels, self.position_ns + 1)
        self._next = next(self._upcoming, None)

    def _catch_up(self, topic: str, subscription: Subscription, is_new: bool) -> None:
        """Deliver the past of a subscription, which is new or asks for what is latched."""
        channels = [channel for channel in self._subscribed() if channel.topic == topic]
        if not channels or self.position_ns < self.history.start_ns:
            return
        self._earlier.look(channels, self.position_ns, is_new=is_new)
        depth = self.history.latched(channels[0], subscription.latched)
        # Which publishers of transforms were still running is unknown, so all of them count.
        latched = Lookback() if subscription.type == TF else Lookback(count=depth)
        lookbacks = (*(subscription.lookbacks if is_new else ()), *([latched] if depth else []))
        if not lookbacks:
            return
        subscriptions = {**self._subscriptions, topic: replace(subscription, lookbacks=lookbacks)}
        needed = NeededMessages(self.history, channels, subscriptions, self.position_ns)
        for recorded in needed.messages():
            self._put(recorded)

    def _arrive(self, recorded: Recorded) -> None:
        self._time.take(recorded)
        if recorded.topic in self._subscriptions:
            self._put(recorded)

    def _put(self, recorded: Recorded) -> None:
        received_ns = self._time.at(recorded.stamp_ns)
        if self.history.is_growing:  # it continues with live messages, which were not recorded
            raw = Raw(recorded.cdr, received_ns)
        else:
            earlier = self._earlier.take(recorded)
            raw = Raw(
                recorded.cdr,
                received_ns,
                recorded_ns=recorded.stamp_ns,
                earlier=earlier,
                types=recorded.types,
            )
        self._deliver(recorded.topic, raw)


def _types(subscriptions: Mapping[str, Subscription]) -> dict[str, str]:
    return {topic: subscription.type for topic, subscription in subscriptions.items()}
