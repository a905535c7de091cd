"""Slices of recordings and of memory, as files of their own."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Protocol

import msgspec

from webviz.api.declared import Topic
from webviz.api.errors import Error
from webviz.api.lookback import Lookback
from webviz.data.messages import KNOWN, MessageError, decode, defined
from webviz.data.recordings import RecordedChannel
from webviz.data.recordings.latched import TF
from webviz.data.recordings.mcap_writing import McapFile
from webviz.sources.bag.comparison import DIFFERENCE, DISTANCE, ComparisonRun
from webviz.sources.bag.file import BagChannel
from webviz.sources.bag.history import BagHistory
from webviz.sources.bag.log import LOG, ROSOUT
from webviz.sources.history import HistoryChannel, NeededMessages, Recorded
from webviz.sources.player import Player
from webviz.sources.recording import Channels, Entry, ForwardClock, library
from webviz.sources.source import Subscription

LOG_LINES = 200
"""The last lines of /rosout that a slice has as text."""
CLOCK_TOPIC = "/clock"

ALWAYS = (CLOCK_TOPIC, ROSOUT, DISTANCE, DIFFERENCE)
"""Topics of each slice; a panel that is closed subscribes to nothing."""

BEFORE_NS, AFTER_NS = 30_000_000_000, 5_000_000_000
"""Time in ns of a bag before and after the moment that is shown, unless a span is selected."""
MIN_S, MAX_S = 0.1, 86_400.0
"""Limits in seconds of a span."""

Margins = tuple[float, float]
"""Seconds before and after the moment that is shown."""

SliceMessage = tuple[RecordedChannel, int, bytes]
"""HistoryChannel, time of recording, and serialised message."""


class Slice(Protocol):
    """A part of a recording that can be written."""

    @property
    def topics(self) -> int:
        """Number of topics."""
        ...

    @property
    def seconds(self) -> float:
        """Duration."""
        ...

    def messages(self) -> Iterator[SliceMessage]:
        """Return the messages in order, latched ones first; may be read in any thread."""
        ...

    def at_ns(self) -> int:
        """Return the moment that was shown, as a time of recording of `messages`.

        Known after them.
        """
        ...


class MemorySlice:
    """All that is remembered of live topics.

    Args:
        channels: of the topics.
        entries: latched ones first, in the order of arrival.
        shown_s: the moment that is shown, as a monotonic time in seconds; None for the last.
    """

    def __init__(
        self, channels: Channels, entries: Sequence[Entry], shown_s: float | None = None
    ) -> None:
        self._channels = channels
        self._entries = entries
        self._shown_s = shown_s
        self._at_ns = 0

    @property
    def topics(self) -> int:
        """`Slice.topics`."""
        return len({topic for topic, _ in self._entries})

    @property
    def seconds(self) -> float:
        """`Slice.seconds`."""
        (_, first), (_, last) = self._entries[0], self._entries[-1]
        return last.arrived_s - first.arrived_s

    def messages(self) -> Iterator[SliceMessage]:
        """`Slice.messages`."""
        clock = ForwardClock()
        for topic, raw in self._entries:
            channel = self._channels.find(topic, raw.types)
            if channel is None:
                continue
            stamp_ns = clock.at(raw)
            if not self._at_ns or self._shown_s is None or raw.arrived_s <= self._shown_s:
                self._at_ns = stamp_ns
            yield channel, stamp_ns, raw.cdr

    def at_ns(self) -> int:
        """`Slice.at_ns`."""
        return self._at_ns


class BagSlice(msgspec.Struct, frozen=True):
    """A span of bags: the subscribed topics, and what displays need of the time before.

    Args:
        paths: of the bags, which are opened anew.
        subscriptions: subscriptions by topic.
        renamed: names of topics that the slice has other names for.
        span_ns: the first and the last time of recording.
        shown_ns: the moment that is shown.
        comparison: a second run beside them.
    """

    paths: Sequence[Path]
    subscriptions: Mapping[str, Subscription]
    renamed: Mapping[str, str]
    span_ns: tuple[int, int]
    shown_ns: int
    comparison: ComparisonRun | None = None

    @property
    def topics(self) -> int:
        """`Slice.topics`."""
        return len(self.subscriptions)

    @property
    def seconds(self) -> float:
        """`Slice.seconds`."""
        return (self.span_ns[1] - self.span_ns[0]) / 1e9

    def messages(self) -> Iterator[SliceMessage]:
        """`Slice.messages`; raises BagError."""
        first_ns, last_ns = self.span_ns
        history = BagHistory(self.paths, comparison=self.comparison)
        try:
            by_channel = {
                HistoryChannel(each.topic, each.type): each for each in history.files.channels
            }
            chosen = {each: own for each, own in by_channel.items() if self._is_chosen(each)}
            subscriptions = {
                each.topic: self._subscription(history, each, own) for each, own in chosen.items()
            }
            before = [each for each in chosen if subscriptions[each.topic].lookbacks]
            for recorded in NeededMessages(history, before, subscriptions, first_ns).messages():
                if recorded.stamp_ns < first_ns:
                    yield self._message(chosen, recorded, first_ns)
            for recorded in history.messages(chosen, first_ns, last_ns):
                yield self._message(chosen, recorded, recorded.stamp_ns)
        finally:
            history.close()

    def at_ns(self) -> int:
        """`Slice.at_ns`."""
        return self.shown_ns

    def _is_chosen(self, channel: HistoryChannel) -> bool:
        if channel.topic in ALWAYS:
            return True
        subscription = self.subscriptions.get(channel.topic)
        return subscription is not None and subscription.type == channel.type

    def _subscription(
        self, history: BagHistory, channel: HistoryChannel, own: BagChannel
    ) -> Subscription:
        """Return the subscription of a channel, with the lookback of latched messages."""
        subscription = self.subscriptions.get(channel.topic)
        if subscription is None:
            subscription = Subscription(channel.type, Topic(channel.topic), lookbacks=())
        is_latched = any(each.durability == "transient_local" for each in own.publishers)
        if channel.topic != ROSOUT and is_latched:
            depth = history.latched(channel, is_latched)
            latched = Lookback() if channel.type == TF else Lookback(count=depth)
            subscription = replace(subscription, lookbacks=(*subscription.lookbacks, latched))
        return subscription

    def _message(
        self, channels: Mapping[HistoryChannel, BagChannel], recorded: Recorded, stamp_ns: int
    ) -> SliceMessage:
        channel = channels[HistoryChannel(recorded.topic, recorded.type)].written
        name = self.renamed.get(recorded.topic, recorded.topic)
        return msgspec.structs.replace(channel, topic=name), stamp_ns, recorded.cdr


class WrittenSlice(msgspec.Struct, frozen=True):
    """A slice that was written.

    Args:
        first_ns, last_ns: times of recording of its first and last message.
        at_ns: the moment that was shown.
        log: the last lines of /rosout.
    """

    first_ns: int
    last_ns: int
    at_ns: int
    log: Sequence[str]


def write_slice(
    part: Slice, path: Path, max_bytes: int, changed: Callable[[bytes], bytes]
) -> WrittenSlice:
    """Write a slice to a new MCAP file.

    Args:
        part: the slice.
        path: of the file.
        max_bytes: of the file.
        changed: makes the message that is written of each.

    Raises:
        Error: it has no messages, or is too large; one sentence.
        OSError: the file cannot be written.
    """
    file = McapFile(path, library())
    lines: deque[SliceMessage] = deque(maxlen=LOG_LINES)
    is_whole = False
    try:
        for channel, stamp_ns, data in part.messages():
            data = changed(data)
            file.add(channel, stamp_ns, data)
            if channel.topic == ROSOUT:
                lines.append((channel, stamp_ns, data))
            _refuse_large(file.size, max_bytes)
        is_whole = True
    finally:
        file.close(is_whole=is_whole)
    _refuse_large(path.stat().st_size, max_bytes)
    if file.span_ns is None:
        raise Error("There are no messages to save. Show a topic first.")
    first_ns, last_ns = file.span_ns
    at_ns = min(max(part.at_ns(), first_ns), last_ns)
    return WrittenSlice(first_ns, last_ns, at_ns, list(filter(None, map(_line, lines))))


def _refuse_large(size: int, max_bytes: int) -> None:
    if size > max_bytes:
        raise Error(
            f"The messages would be larger than {max_bytes // 1_000_000} MB. Choose a shorter time "
            "span, or hide displays of large messages."
        )


def _line(entry: SliceMessage) -> str:
    """Return a message of /rosout as a line, "" if it cannot be read."""
    channel, stamp_ns, data = entry
    if channel.type != LOG:
        return ""
    types = defined(LOG, channel.definition) if channel.definition else KNOWN
    try:
        message = decode(LOG, data, types)
    except MessageError:
        return ""
    level = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL"}.get(message.level, "?")
    when = datetime.fromtimestamp(stamp_ns / 1e9, UTC).isoformat(timespec="milliseconds")
    return f"{when} {level:5} {message.name}: {message.msg}"


def margins(before_s: float | None, after_s: float | None) -> Margins | None:
    """Return the margins that a command asks for, None if it leaves them open.

    Raises:
        Error: one is negative or too long, or both are zero.
    """
    if before_s is None and after_s is None:
        return None
    before_s, after_s = before_s or 0.0, after_s or 0.0
    if not (0.0 <= before_s <= MAX_S and 0.0 <= after_s <= MAX_S and before_s + after_s > 0.0):
        raise Error("This is not a valid time span. Give seconds before and after the moment.")
    return before_s, after_s


def slice_around(player: Player, around: Margins | None = None) -> tuple[Slice, str]:
    """Return the slice around the moment that is shown, and the name of its source.

    Of a bag it has the subscribed topics, and what displays need of the time before.

    Args:
        player: of what is shown.
        around: the span; None is the selected one or half a minute of a bag, and all of memory. The
            past of live topics is always shared as a whole.

    Raises:
        Error: nothing has been received yet.
    """
    history = player.history
    if isinstance(history, BagHistory):
        at_ns = min(player.position_ns, history.end_ns)
        if around is not None:
            first_ns, last_ns = at_ns - _ns(around[0]), at_ns + _ns(around[1])
        else:
            first_ns, last_ns = player.selected or (at_ns - BEFORE_NS, at_ns + AFTER_NS)
        first_ns, last_ns = min(first_ns, at_ns), max(last_ns, at_ns)
        span_ns = max(first_ns, history.start_ns), min(last_ns, history.end_ns)
        renamed = {ours: theirs for theirs, ours in history.remappings.items()}
        subscriptions = dict(player.subscriptions)
        part = BagSlice(history.paths, subscriptions, renamed, span_ns, at_ns, history.comparison)
        return part, ", ".join(history.names)
    memory = player.memory
    if around is not None and player.is_live and memory is not None:
        entries: Sequence[Entry] = memory.recent.last(max(around[0], MIN_S)).whole
    else:
        entries = () if memory is None else memory.entries()
    if memory is None or not entries:
        raise Error(
            "No messages are kept in memory. Show a topic, or raise memory.seconds in the config."
        )
    shown_s = None if player.is_live else memory.clock.arrived_s(player.reached_ns)
    return MemorySlice(memory.recorded_channels, entries, shown_s), "live"


def _ns(seconds: float) -> int:
    return round(seconds * 1e9)
