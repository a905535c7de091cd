"""A recorded bag as a source: playing it delivers its messages."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path

from webviz.api.lookback import Lookback
from webviz.api.offer import Offer, Publisher
from webviz.data.disk import in_thread
from webviz.data.messages import MessageError, register
from webviz.sources.bag.earlier import EarlierMessages
from webviz.sources.bag.extras import Extra
from webviz.sources.bag.file import BagChannel, BagError, Recorded
from webviz.sources.bag.files import BagFiles
from webviz.sources.bag.frames import frames_of, links_of
from webviz.sources.bag.ghost import Ghost, ghost_files
from webviz.sources.bag.log import LogReader
from webviz.sources.bag.past import BagPast
from webviz.sources.bag.qos import weakest
from webviz.sources.bag.time import CLOCK, TF, BagTime
from webviz.sources.bag.transform_runs import TransformRuns
from webviz.sources.graph import ReadOnly
from webviz.sources.inbox import MAX_BYTES, Inbox, Raw
from webviz.sources.names import resolved
from webviz.sources.past_state import Event
from webviz.sources.replay import Replay
from webviz.sources.slices import BagSlice
from webviz.sources.source import Subscription

INBOX_LIMIT = 20_000
"""Messages per topic; all latched messages arrive at once."""
NONE = "the bag has none"
"""When the first message of a topic comes."""
NOT_COUNTED: Mapping[str, Sequence[int]] = {}


class BagSource:
    """Messages of mcap files, db3 files or rosbag2 folders, merged by time, without ROS.

    Time advances with `play` only. Any requested QoS is accepted.

    Positions in the bag are times of recording. ROS time (`now_ns`) differs for a robot with
    simulated time: it follows the recorded /clock, or else the transforms.

    Args:
        paths: of the bag, or of several.
        extras: messages that the bag lacks, latched from its start on.
        remappings: full topic names by the full names that displays use.
        ghost: a second run to show beside it, with topics of its own.

    Raises:
        BagError: a bag cannot be read.
    """

    def __init__(
        self,
        paths: Path | Sequence[Path],
        extras: Sequence[Extra] = (),
        remappings: Mapping[str, str] | None = None,
        ghost: Ghost | None = None,
    ) -> None:
        self.inbox = Inbox()
        self.graph = ReadOnly("A bag is read-only. Connect to a live ROS graph to publish.")
        paths = [paths] if isinstance(paths, Path) else paths
        self._paths = tuple(paths)
        self.ghost = ghost
        self._file = BagFiles(paths, ghost_files(paths, ghost) if ghost else ())
        self._log = LogReader(paths, self.inbox.arrived.set)
        self._runs = TransformRuns(paths)
        self._extras = tuple(extras)
        self._remappings = dict(remappings or {})
        self._time = BagTime(self._file)
        self._replay: Replay[BagChannel, Recorded] = Replay(self._file, self._arrive)
        self._wanted: dict[str, Subscription] = {}
        self._problems: dict[str, str] = {}
        self._begins: dict[str, str] = {}
        self._earlier = EarlierMessages(self._file)
        self._offers = self._all_offers()
        self._served: dict[str, str] = {}
        """Types by topic, of subscriptions that get their past from the seek before."""
        self._counting: Future[Mapping[str, Sequence[int]]] | None = None

    bridges = ()
    """A bag needs no bridge,"""
    absence = ""
    """has a past,"""
    is_live = False
    """and nothing else,"""
    gap_ns = counted_ns = None
    """of which nothing is forgotten, and all is counted."""

    @property
    def origin_ns(self) -> int:
        """The start."""
        return self.start_ns

    @property
    def start_ns(self) -> int:
        """Stamp of the first message."""
        return self._file.start_ns

    @property
    def end_ns(self) -> int:
        """Stamp of the last message."""
        return self._file.end_ns

    @property
    def position_ns(self) -> int:
        """The position in the bag: everything recorded until then has arrived."""
        return self._replay.position_ns

    @property
    def warnings(self) -> list[str]:
        """Warnings: subscribed topics that cannot be read, missing files, damage, unusual time."""
        skipped = [
            f"{topic} is skipped: {why}."
            for topic, why in self._file.skipped.items()
            if topic in self._wanted
        ]
        others = filter(None, [self._time.warning, self._log.read.warning])
        return [*skipped, *self._file.warnings, *others]

    def play(self, until_ns: int) -> None:
        """Deliver everything recorded until a time of recording.

        If that is too much for the inbox, `position_ns` stays behind and the next call continues.

        Raises:
            BagError: the file can no longer be read.
        """
        self._replay.play(until_ns)
        self.inbox.arrived.set()

    def play_step(self, until_ns: int) -> None:
        """Play a short step towards a time, or up to the next message if that is later.

        Raises:
            BagError: the file can no longer be read.
        """
        self._replay.play_step(until_ns)
        self.inbox.arrived.set()

    @property
    def next_ns(self) -> int:
        """Stamp of the next message of the subscriptions; that of the end after the last one."""
        return self._replay.next_ns

    @property
    def names(self) -> Sequence[str]:
        """Names of the files or folders."""
        return self._file.names

    def seek(self, at_ns: int) -> None:
        """`Playable.seek`: reads what the subscriptions need of the past, and then on."""
        self.inbox.drain()
        self._replay.seek(at_ns, self._channels_to_read(), self._wanted, self._runs.found())
        self._time.seek(self.position_ns)
        self._earlier.clear()
        self._earlier.look(self._channels(), at_ns, is_new=True)
        for extra in self._extras:
            self._put(Recorded(extra.topic, extra.type, extra.cdr, self._file.start_ns))
        self._served = _types(self._wanted)

    def rejoin(self, at_once: bool = False) -> bool:
        """Do nothing."""
        return False

    def neighbour(self, topic: str, is_forward: bool) -> int | None:
        """`Playable.neighbour`."""
        channels = [
            channel
            for channel in self._file.channels
            if (channel.topic == topic if topic else self._is_shown(channel))
        ]
        return self._replay.neighbour(channels, is_forward)

    def histogram(self, buckets: int) -> Mapping[str, Sequence[int]]:
        """`Playable.histogram`; none until a worker has counted."""
        if self._counting is None:
            self._counting = in_thread(lambda: self._file.histogram(buckets))
            self._counting.add_done_callback(lambda _: self.inbox.arrived.set())
        counted = self._counting
        return counted.result() if counted.done() and not counted.exception() else NOT_COUNTED

    def logged(self) -> Sequence[Event]:
        """`Playable.logged`; none until a worker has read them."""
        self._log.start(self._file)
        return self._log.read.events

    def slice(self, first_ns: int, last_ns: int, shown_ns: int) -> BagSlice:
        """Return the subscribed topics in a span, and what displays need of the time before."""
        renamed = {ours: theirs for theirs, ours in self._remappings.items()}
        span_ns = max(first_ns, self.start_ns), min(last_ns, self.end_ns)
        wanted = dict(self._wanted)
        return BagSlice(self._paths, wanted, renamed, span_ns, shown_ns, self.ghost)

    def links(self) -> Sequence[tuple[str, str]]:
        """Parents and children of the static transforms and of the first ones that move."""
        return links_of(self._file)

    def has(self, topic: str) -> bool:
        """Return whether a topic has messages, or may have if that takes long to find out."""
        return self._file.is_used(topic) or any(extra.topic == topic for extra in self._extras)

    def frames(self, topics: Collection[str]) -> Sequence[str]:
        """Return the frames of the first messages on some topics, each once."""
        return frames_of(self._file, [c for c in self._file.channels if c.topic in topics])

    # The interface of webviz.sources.Source

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these; latched messages arrive at once."""
        before, self._wanted = self._wanted, dict(subscriptions)
        if before == self._wanted:
            return
        for topic in before.keys() - subscriptions.keys():
            self.inbox.close(topic)
        fresh = {t: s for t, s in self._wanted.items() if _is_new(s, before.get(t))}
        for topic in fresh.keys() - before.keys():
            self.inbox.open(topic, INBOX_LIMIT)
        types = _types(before)
        new = {
            topic: subscription
            for topic, subscription in fresh.items()
            if types.get(topic) != subscription.type
        }
        self._learn(new)
        self._begins |= {topic: self._beginning(topic) for topic in new}
        served, self._served = self._served, {}
        for topic, subscription in fresh.items():
            if served.get(topic) == subscription.type:
                continue
            self._put_extras(topic)
            if topic in new:
                self._catch_up(topic, subscription)
            else:  # as after a reset, which has forgotten what came before
                own = [channel for channel in self._channels() if channel.topic == topic]
                self._earlier.look(own, self.position_ns, is_new=False)
                self._repeat(topic, subscription)
        if types != _types(self._wanted):
            self._replay.read_on(self._channels_to_read())
        self._offers = self._all_offers()

    def offers(self) -> Mapping[str, Offer]:
        """Return the topics of the bag, with the QoS that publishers offered."""
        return self._offers

    def now_ns(self) -> int:
        """ROS time at the position in the bag; it is known also where it is 0 or less."""
        return max(self._time.at(self.position_ns), 1)

    def clock_messages(self) -> int | None:
        """Time comes from the bag; its /clock is not counted."""
        return 0

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic, remapped; those in the bag are valid.

        Raises:
            ValueError: it is not a valid topic name.
        """
        return resolved(topic, self._remappings, self._file.topics)

    def close(self) -> None:
        """Close the file."""
        self._runs.close()
        self._file.close()

    # Internal

    def _is_shown(self, channel: BagChannel) -> bool:
        """Return whether displays subscribe to a channel."""
        return channel.topic in self._wanted and channel.type not in (TF, CLOCK)

    def _channels(self) -> list[BagChannel]:
        """Return the subscribed channels that can be read."""
        return [
            channel
            for channel in self._file.channels
            if (subscription := self._wanted.get(channel.topic))
            and subscription.type == channel.type
            and channel.topic not in self._problems
        ]

    def _channels_to_read(self) -> list[BagChannel]:
        """Return the channels to read, always including the clock."""
        wanted = self._channels()
        return wanted + [c for c in self._time.clocks if c not in wanted]

    def _learn(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Register the message definitions of the bag."""
        for channel in self._file.channels:
            subscription = subscriptions.get(channel.topic)
            if subscription and subscription.type == channel.type and channel.recorded.definition:
                try:
                    register(channel.type, channel.recorded.definition)
                except MessageError as error:
                    self._problems[channel.topic] = str(error)

    def _catch_up(self, topic: str, subscription: Subscription) -> None:
        """Deliver what a new subscription would hold if it had been there from the start."""
        channels = [channel for channel in self._channels() if channel.topic == topic]
        if channels and self.position_ns >= self._file.start_ns:
            depth = sum(channel.depth for channel in self._latched(topic, subscription))
            lookbacks = (*subscription.lookbacks, *([Lookback(count=depth)] if depth else []))
            wanted = self._wanted | {topic: replace(subscription, lookbacks=lookbacks)}
            self._earlier.look(channels, self.position_ns, is_new=True)
            runs = self._runs.found()
            past = BagPast(self._file, channels, wanted, self.position_ns, runs)
            for recorded in past.messages():
                self._put(recorded)

    def _put_extras(self, topic: str) -> None:
        for extra in self._extras:
            if extra.topic == topic:
                self._put(Recorded(topic, extra.type, extra.cdr, self._file.start_ns))

    def _repeat(self, topic: str, subscription: Subscription) -> None:
        """Deliver what publishers repeat for a subscription that is made anew."""
        latched = self._latched(topic, subscription)
        # Which publishers of transforms were still running is unknown, so all of them count.
        is_tf = subscription.type == TF
        depth = INBOX_LIMIT if is_tf else sum(channel.depth for channel in latched)
        past: list[Recorded] = []
        size = 0
        for recorded in itertools.islice(self._file.newest(latched, self.position_ns), depth):
            size += len(recorded.cdr)
            if past and size > MAX_BYTES:
                break
            past.append(recorded)
        for recorded in reversed(past):
            self._put(recorded)

    def _latched(self, topic: str, subscription: Subscription) -> Sequence[BagChannel]:
        """Return the channels of a topic whose publishers repeat their last messages."""
        return [
            channel
            for channel in self._channels()
            if channel.topic == topic
            and (subscription.latched or weakest(channel.publishers)[1] == "transient_local")
        ]

    def _arrive(self, recorded: Recorded) -> None:
        if recorded.topic == "/clock" and recorded.type == CLOCK:
            self._time.update(recorded)
        self._put(recorded)

    def _put(self, recorded: Recorded) -> None:
        received_ns, earlier = self._time.at(recorded.stamp_ns), self._earlier.take(recorded)
        raw = Raw(recorded.cdr, received_ns, recorded_ns=recorded.stamp_ns, earlier=earlier)
        self.inbox.put(recorded.topic, raw)

    def _all_offers(self) -> Mapping[str, Offer]:
        publishers: dict[str, tuple[Publisher, ...]] = {}
        for channel in self._file.channels:
            publishers[channel.topic] = publishers.get(channel.topic, ()) + channel.publishers
        for extra in self._extras:
            publishers[extra.topic] = (*publishers.get(extra.topic, ()), extra.publisher)
        offers = {topic: self._offer(topic, who) for topic, who in publishers.items()}
        for topic, reason in self._file.skipped.items():
            offers.setdefault(topic, Offer((), None, reason))
        return offers

    def _offer(self, topic: str, publishers: tuple[Publisher, ...]) -> Offer:
        subscription, problem = self._wanted.get(topic), self._problems.get(topic, "")
        matching = [p for p in publishers if subscription and p.type == subscription.type]
        if subscription is None or not matching:
            return Offer(publishers, None, problem, is_recorded=True)
        begins = self._begins.get(topic, "")
        qos = weakest(matching)
        return Offer(publishers, qos, problem, subscription.type, is_recorded=True, begins=begins)

    def _beginning(self, topic: str) -> str:
        """When a topic begins, in words."""
        if any(extra.topic == topic for extra in self._extras):
            return ""
        if not self._file.is_used(topic):
            return NONE
        channels = [channel for channel in self._channels() if channel.topic == topic]
        first = next(self._file.messages(channels, self._file.start_ns), None)
        if first is None:
            return NONE
        self._earlier.note_first(first)
        return f"the bag's first is at {(first.stamp_ns - self.start_ns) / 1e9:.1f} s"


def _is_new(subscription: Subscription, before: Subscription | None) -> bool:
    """Return whether a subscription asks for latched messages."""
    return before is None or before.type != subscription.type or subscription.asked > before.asked


def _types(subscriptions: Mapping[str, Subscription]) -> dict[str, str]:
    return {topic: subscription.type for topic, subscription in subscriptions.items()}


__all__ = ["BagError", "BagSource"]
