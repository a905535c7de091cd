"""Recorded bags as a history, without ROS."""

from __future__ import annotations

import concurrent.futures
import itertools
import threading
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path

from webviz.api.offer import Offer, Publisher
from webviz.data.disk import DiskThreads, in_thread
from webviz.data.messages import MessageError, TFMessage, decode, peek_header
from webviz.data.messages.typestore import fields
from webviz.data.recordings.latched import TF
from webviz.sources.bag.comparison import ComparisonRun, comparison_files
from webviz.sources.bag.extras import Extra
from webviz.sources.bag.file import BagChannel, BagError
from webviz.sources.bag.files import BagFiles
from webviz.sources.bag.log import LogReader
from webviz.sources.bag.qos import weakest
from webviz.sources.bag.time import BagTime
from webviz.sources.history import CLOCK, HistoryChannel, Recorded, ValidityIntervals
from webviz.sources.names import resolved
from webviz.sources.past_state import Event
from webviz.sources.source import Subscription

MAX_MESSAGES = 1_000_000
"""Largest number of messages whose frames are looked at: nine hours at 30 a second."""
WAIT_S = 1.0
"""Time in seconds for the first seek; a bag of ten minutes takes some tenths."""
MAX_STATIC = 10_000
"""Messages of static transforms."""
AT_ONCE = 50_000
"""Messages that are read without a pause."""
YIELD_AFTER, YIELD_S = 500, 0.02
"""Number of messages of a longer bag between two pauses, and their length, so that the frame loop
has the interpreter."""

_readers = DiskThreads(16)
"""Threads for whole bags, which take longer than other files."""


class IntervalReader:
    """Finds validity intervals in a worker, once they are asked for.

    Args:
        paths: of the bags, which it opens anew.
    """

    def __init__(self, paths: Sequence[Path]) -> None:
        self._paths = paths
        self._reading: Future[ValidityIntervals] | None = None
        self._is_closed = threading.Event()

    def intervals(self) -> ValidityIntervals:
        """Return the intervals; none before they are read, for which the first call waits a bit."""
        wait_s = 0.0
        if self._reading is None:
            try:
                self._reading = _readers.start(self._read)
            except OSError:  # no thread is free; another time
                return ValidityIntervals()
            wait_s = WAIT_S
        concurrent.futures.wait([self._reading], wait_s)
        # That a bag can no longer be read, others report.
        is_read = self._reading.done() and not self._reading.exception()
        return self._reading.result() if is_read else ValidityIntervals()

    def close(self) -> None:
        """Stop reading."""
        self._is_closed.set()

    def _read(self) -> ValidityIntervals:
        validity = ValidityIntervals()
        bags = BagFiles(self._paths)
        static = [c for c in bags.channels if c.type == TF and c.topic.endswith("/tf_static")]
        moving = [c for c in bags.channels if c.type == TF and c not in static]
        try:
            for recorded in itertools.islice(bags.messages(static, bags.start_ns), MAX_STATIC):
                validity.read(recorded.cdr, recorded.stamp_ns, is_static=True)
            for number, recorded in enumerate(bags.messages(moving, bags.start_ns), 1):
                if number > MAX_MESSAGES or self._is_closed.is_set():
                    break
                validity.read(recorded.cdr, recorded.stamp_ns)
                if number > AT_ONCE and number % YIELD_AFTER == 0:
                    self._is_closed.wait(YIELD_S)
        finally:
            bags.close()
        return validity


MAX_READ = 1000
"""Messages of each kind."""
READ_NS = 60_000_000_000
"""Time in ns at the beginning of a bag that is read. To learn that a db3 file has no more messages
of a rare topic would take reading all of it."""


def links_of(file: BagFiles) -> Sequence[tuple[str, str]]:
    """Parents and children of the first transforms, each once."""
    links: dict[tuple[str, str], None] = {}
    for topic in ("/tf_static", "/tf"):
        channels = [c for c in file.channels if (c.topic, c.type) == (topic, TF)]
        for recorded in _first(file, channels):
            try:
                message: TFMessage = decode(TF, recorded.cdr)
            except MessageError:
                continue
            for each in message.transforms:
                links[each.parent.removeprefix("/"), each.child.removeprefix("/")] = None
    return list(links)


def frames_of(file: BagFiles, channels: Collection[BagChannel]) -> Sequence[str]:
    """Return the frames of the first messages of some channels, each once."""
    names: dict[str, None] = {}
    for recorded in _first(file, channels):
        try:
            header = peek_header(recorded.type, recorded.cdr, recorded.types)
        except MessageError:
            continue
        if header and header[0]:
            names[header[0].removeprefix("/")] = None
    return list(names)


def _first(file: BagFiles, channels: Collection[BagChannel]) -> Iterator[Recorded]:
    """Yield the first messages of some channels."""
    early = file.messages(channels, file.start_ns, file.start_ns + READ_NS)
    first = next(early, None) or next(file.messages(channels, file.start_ns), None)
    if first is not None:
        yield from itertools.islice(itertools.chain([first], early), MAX_READ)


NONE = "the bag has none"
"""Answer when a topic has no message to come."""
NOT_COUNTED: Mapping[str, Sequence[int]] = {}
CLOCK_CHANNEL = HistoryChannel("/clock", CLOCK)


class BagHistory:
    """Messages of mcap files, db3 files or rosbag2 folders, merged by time.

    Times are times of recording. ROS time differs for a robot with simulated time: it follows the
    recorded /clock, or else the transforms.

    Args:
        paths: of the bag, or of several.
        extras: messages that the bag lacks, latched from its start on.
        remappings: full topic names by the full names that displays use.
        comparison: a second run to show beside it, with topics of its own.

    Raises:
        BagError: a bag cannot be read.
    """

    is_growing = False
    gap_ns = counted_ns = None
    """Nothing is forgotten, and all is counted."""

    def __init__(
        self,
        paths: Path | Sequence[Path],
        extras: Sequence[Extra] = (),
        remappings: Mapping[str, str] | None = None,
        comparison: ComparisonRun | None = None,
    ) -> None:
        self.paths = (paths,) if isinstance(paths, Path) else tuple(paths)
        self.comparison = comparison
        self.extras = tuple(extras)
        self.remappings = dict(remappings or {})
        others = comparison_files(self.paths, comparison) if comparison else ()
        self.files = BagFiles(self.paths, others, extras)
        self.wake: Callable[[], object] = lambda: None
        """Called in a worker when `histogram` or `logged` know more."""
        self._own: dict[HistoryChannel, list[BagChannel]] = {}
        for channel in self.files.channels:
            self._own.setdefault(HistoryChannel(channel.topic, channel.type), []).append(channel)
        self._time = BagTime(self.files)
        self._log = LogReader(self.paths, lambda: self.wake())
        self._validity = IntervalReader(self.paths)
        self._problems: dict[HistoryChannel, str] = {}
        self._firsts: dict[HistoryChannel, int | None] = {}
        self._offers: tuple[object, Mapping[str, Offer]] = None, {}
        self._counting: Future[Mapping[str, Sequence[int]]] | None = None

    @property
    def names(self) -> Sequence[str]:
        """Names of the files or folders."""
        return self.files.names

    @property
    def origin_ns(self) -> int:
        """The start."""
        return self.files.start_ns

    start_ns = origin_ns

    @property
    def last_ns(self) -> int:
        """Time of the last message."""
        return self.files.end_ns

    end_ns = last_ns

    def refresh(self) -> bool:
        """Nothing is added to a bag that was opened."""
        return False

    def channels(self, subscriptions: Mapping[str, Subscription]) -> Sequence[HistoryChannel]:
        """`History.channels`: those that can be read, and always the clock."""
        wished = (HistoryChannel(topic, each.type) for topic, each in subscriptions.items())
        chosen = [each for each in wished if each in self._own and not self._problem(each)]
        has_clock = CLOCK_CHANNEL in self._own and CLOCK_CHANNEL not in chosen
        return [*chosen, CLOCK_CHANNEL] if has_clock else chosen

    def channels_of(self, topic: str) -> Sequence[HistoryChannel]:
        """`History.channels_of`."""
        return [channel for channel in self._own if channel.topic == topic]

    def messages(
        self, channels: Collection[HistoryChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """`History.messages`."""
        return self.files.messages(self._in_files(channels), start_ns, end_ns)

    def newest(self, channels: Collection[HistoryChannel], end_ns: int) -> Iterator[Recorded]:
        """`History.newest`."""
        return self.files.newest(self._in_files(channels), end_ns)

    def newest_stamps(self, channels: Collection[HistoryChannel], end_ns: int) -> Iterator[int]:
        """`History.newest_stamps`."""
        return self.files.newest_stamps(self._in_files(channels), end_ns)

    def first_ns(self, channel: HistoryChannel) -> int | None:
        """`History.first_ns`."""
        if channel not in self._firsts:
            is_used = self.files.is_used(channel.topic)
            first = next(self.messages([channel], self.start_ns), None) if is_used else None
            self._firsts[channel] = first.stamp_ns if first else None
        return self._firsts[channel]

    def latched(self, channel: HistoryChannel, is_wanted: bool) -> int:
        """`History.latched`."""
        own = self._own.get(channel, ())
        is_latched = is_wanted or weakest(_publishers(own))[1] == "transient_local"
        return sum(each.depth for each in own) if is_latched else 0

    def validity(self) -> ValidityIntervals:
        """`History.validity`, as far as a worker has found them."""
        return self._validity.intervals()

    def time(self) -> BagTime:
        """`History.time`."""
        return self._time.copy()

    def offers(self, subscriptions: Mapping[str, Subscription]) -> Mapping[str, Offer]:
        """`History.offers`, with the QoS that publishers offered."""
        if self._offers[0] is not subscriptions:
            publishers: dict[str, tuple[Publisher, ...]] = {}
            for channel in self.files.channels:
                publishers[channel.topic] = publishers.get(channel.topic, ()) + channel.publishers
            offers = {
                topic: self._offer(topic, who, subscriptions.get(topic))
                for topic, who in publishers.items()
            }
            for topic, reason in self.files.skipped.items():
                offers.setdefault(topic, Offer((), None, reason))
            self._offers = subscriptions, offers
        return self._offers[1]

    def warnings(self, subscriptions: Mapping[str, Subscription]) -> Sequence[str]:
        """`History.warnings`: topics that cannot be read, missing files, damage, unusual time."""
        skipped = [
            f"{topic} is skipped: {why}."
            for topic, why in self.files.skipped.items()
            if topic in subscriptions
        ]
        others = filter(None, [self._time.warning, self._log.read.warning])
        return [*skipped, *self.files.warnings, *others]

    def histogram(self, parts: int) -> Mapping[str, Sequence[int]]:
        """`History.histogram`; none until a worker has counted."""
        if self._counting is None:
            self._counting = in_thread(lambda: self.files.histogram(parts))
            self._counting.add_done_callback(lambda _: self.wake())
        counted = self._counting
        return counted.result() if counted.done() and not counted.exception() else NOT_COUNTED

    def logged(self) -> Sequence[Event]:
        """`History.logged`; none until a worker has read them."""
        self._log.start(self.files)
        return self._log.read.events

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic, remapped; those in the bag are valid.

        Raises:
            ValueError: it is not a valid topic name.
        """
        return resolved(topic, self.remappings, self.files.topics)

    def close(self) -> None:
        """Close the files."""
        self._validity.close()
        self.files.close()

    # For configs that are made of a bag

    def links(self) -> Sequence[tuple[str, str]]:
        """Parents and children of the static transforms and of the first ones that move."""
        return links_of(self.files)

    def has(self, topic: str) -> bool:
        """Return whether a topic has messages, or may have if that takes long to find out."""
        return self.files.is_used(topic)

    def frames(self, topics: Collection[str]) -> Sequence[str]:
        """Return the frames of the first messages on some topics, each once."""
        return frames_of(self.files, [c for c in self.files.channels if c.topic in topics])

    # Internal

    def _in_files(self, channels: Collection[HistoryChannel]) -> list[BagChannel]:
        return [own for channel in channels for own in self._own.get(channel, ())]

    def _problem(self, channel: HistoryChannel) -> str:
        """Return why messages cannot be decoded, "" if they can."""
        if channel not in self._problems:
            self._problems[channel] = ""
            for own in self._own[channel]:
                try:
                    fields(own.type, own.types)
                except MessageError as error:
                    self._problems[channel] = str(error)
        return self._problems[channel]

    def _offer(
        self, topic: str, publishers: tuple[Publisher, ...], subscription: Subscription | None
    ) -> Offer:
        channel = HistoryChannel(topic, subscription.type if subscription else "")
        if subscription is None or channel not in self._own:
            return Offer(publishers, None, is_recorded=True)
        problem = self._problem(channel)
        qos = weakest(_publishers(self._own[channel]))
        begins = "" if problem else self._beginning(channel)
        return Offer(publishers, qos, problem, channel.type, is_recorded=True, begins=begins)

    def _beginning(self, channel: HistoryChannel) -> str:
        """Return when a topic begins, in words."""
        first_ns = self.first_ns(channel)
        if first_ns is None:
            return NONE
        return f"the bag's first is at {(first_ns - self.start_ns) / 1e9:.1f} s"


def _publishers(channels: Collection[BagChannel]) -> list[Publisher]:
    return [publisher for channel in channels for publisher in channel.publishers]


__all__ = ["BagError", "BagHistory"]
