"""Live topics whose last minutes can be played again."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from webviz.api.bridge import Bridge
from webviz.api.declared import Topic
from webviz.api.lookback import Lookback
from webviz.data.recordings.latched import STATIC_TF
from webviz.sources.bag.log import LOG, ROSOUT
from webviz.sources.bag.past import BagPast
from webviz.sources.bag.time import TF
from webviz.sources.bag.transform_runs import Runs
from webviz.sources.graph import Graph
from webviz.sources.inbox import Raw
from webviz.sources.live_histogram import LiveHistogram
from webviz.sources.live_log import LiveLog
from webviz.sources.memory_past import MemoryChannel, MemoryMessage, MemoryPast, WallClock
from webviz.sources.past_state import Event
from webviz.sources.recording import Channels, Entry, RecentMessages
from webviz.sources.replay import Replay
from webviz.sources.slices import MemorySlice
from webviz.sources.source import Offer, Source, Subscription

NEARLY_NS = 150_000_000
"""Before now, where playing becomes live: what arrived until then is in memory for sure."""
NOT_REMEMBERED = "none was received before this moment, since only displayed topics are remembered"
"""Why a topic has no message in the past."""
MEMORY_OFF = (
    "Live topics are not remembered, so there is no past to show. Raise memory.seconds and "
    "memory.megabytes in the config, or start webviz with --memory 60s."
)


class Rewindable:
    """A live source and its memory, as one source with a past.

    While it is rewound, live messages go to the memory only, and those of the past to the inbox.
    What was in memory when it was rewound stays until it is live again, besides the last minutes:
    the moment that people look at is not forgotten.

    Args:
        live: the source.
    """

    def __init__(self, live: Source) -> None:
        self.live = live
        self.inbox = live.inbox
        self.channels = Channels(live.offers)
        self.memory = RecentMessages(self.channels.latched)
        self._clock = WallClock()
        self._origin_ns = self._clock.now_ns()
        self._histogram = LiveHistogram(self.memory, self._clock)
        self._log = LiveLog(self._clock)
        live.inbox.read_along(lambda: self._log.put)
        self._held: list[Entry] = []
        self._replay: Replay[MemoryChannel, MemoryMessage] | None = None
        """None while live."""
        self._runs = Runs()
        self._runs_until_s = 0.0
        """Arrival of the last message of which the runs know, in monotonic seconds."""
        self._wanted: dict[str, Subscription] = {}
        self._told: dict[str, Subscription] = {}
        """As the live source knows them."""
        self._asked: dict[str, tuple[int, int]] = {}
        """By topic: `asked` of the subscription, and of what the live source was told."""
        self._served: dict[str, str] = {}
        """Types by topic, of subscriptions that get their past from the seek before."""
        self._offers: tuple[object, object, Mapping[str, Offer]] = None, None, {}

    # The interface of webviz.engine.playback.Playable

    @property
    def absence(self) -> str:
        """Return why there is no past, "" if there is one."""
        return "" if self.memory.is_on or not self.is_live else MEMORY_OFF

    @property
    def is_live(self) -> bool:
        """Return whether what arrives is shown."""
        return self._replay is None

    @property
    def origin_ns(self) -> int:
        """The beginning of the viewer."""
        return self._origin_ns

    @property
    def start_ns(self) -> int:
        """Time of the oldest message."""
        if self._held:
            return self._clock.stamp_ns(self._held[0][1].arrived_s)
        oldest_s = self.memory.oldest_s
        return self.end_ns if oldest_s is None else self._clock.stamp_ns(oldest_s)

    @property
    def end_ns(self) -> int:
        """Now."""
        return self._clock.now_ns()

    @property
    def position_ns(self) -> int:
        """The position; now while live."""
        return self.end_ns if self._replay is None else self._replay.position_ns

    @property
    def gap_ns(self) -> tuple[int, int] | None:
        """From the newest message that is held to the oldest in memory, if it is older."""
        oldest_s = self.memory.oldest_s
        held_s = self._held[-1][1].arrived_s if self._held else math.inf
        if oldest_s is None or self.memory.forgotten_s <= held_s:
            return None
        return self._clock.stamp_ns(held_s), self._clock.stamp_ns(oldest_s)

    @property
    def names(self) -> Sequence[str]:
        """None: topics have names of their own."""
        return ()

    @property
    def warnings(self) -> Sequence[str]:
        """None."""
        return ()

    def play(self, until_ns: int) -> None:
        """`Playable.play`."""
        if self._replay is not None:
            self._catch_up_with_memory()
            self._replay.play(min(until_ns, self.end_ns - NEARLY_NS))
            self.inbox.arrived.set()

    def play_step(self, until_ns: int) -> None:
        """`Playable.play_step`."""
        if self._replay is not None:
            self._catch_up_with_memory()
            self._replay.play_step(min(until_ns, self.end_ns - NEARLY_NS))
            self.inbox.arrived.set()

    def seek(self, at_ns: int) -> None:
        """`Playable.seek`; what is live goes to the memory only from now on."""
        if self._replay is None:
            self.inbox.divert()
            self._held = self.memory.last(math.inf).whole
            self._histogram.hold()
            self._runs, self._runs_until_s = Runs(), -math.inf
        if not self._held:
            self._become_live()
            return
        self.inbox.drain()
        newest = self.memory.after(self._held[-1][1].arrived_s)
        past = MemoryPast([*self._held, *newest], self._clock)
        if self._replay is None:
            self._note_runs(self._held)
            self._replay = Replay(past, self._deliver)
        self._note_runs(newest)
        self._replay.past = past
        at_ns = min(at_ns, self.end_ns - NEARLY_NS)
        self._replay.seek(at_ns, self._channels_to_read(), self._wanted, self._runs)
        self._served = {topic: subscription.type for topic, subscription in self._wanted.items()}

    def rejoin(self, at_once: bool = False) -> bool:
        """`Playable.rejoin`."""
        position_ns = self.position_ns
        if self._replay is not None and (at_once or self.end_ns - position_ns <= 2 * NEARLY_NS):
            self._become_live()
        return self.is_live

    def neighbour(self, topic: str, is_forward: bool) -> int | None:
        """`Playable.neighbour`."""
        entries = self._held or self.memory.last(math.inf).whole
        if not entries:
            return None
        channels = [c for c in self._channels_to_read() if c.topic == topic or not topic]
        if not topic:
            channels = [c for c in channels if c.type != "tf2_msgs/msg/TFMessage"]
        past = self._past() if self._held else MemoryPast(entries, self._clock)
        replay = Replay(past, self._deliver)
        replay.position_ns = self.position_ns
        return replay.neighbour(channels, is_forward)

    def histogram(self, buckets: int) -> Mapping[str, Sequence[int]]:
        """`Playable.histogram`, in parts of a second or more."""
        return self._histogram.counts(self.end_ns)

    @property
    def counted_ns(self) -> tuple[int, int]:
        """`Playable.counted_ns`."""
        return self._histogram.span_ns

    def logged(self) -> Sequence[Event]:
        """`Playable.logged`, of what was received."""
        return self._log.events(self.start_ns)

    def slice(self) -> MemorySlice | None:
        """All that is remembered, with the moment that is shown; None if there is nothing."""
        entries = self._held or self.memory.last(math.inf).whole
        if not entries:
            return None
        if self._replay is None:
            return MemorySlice(self.channels, entries)
        newest = self.memory.after(self._held[-1][1].arrived_s)
        shown_s = self._clock.arrived_s(self._replay.position_ns)
        return MemorySlice(self.channels, [*self._held, *newest], shown_s)

    # The interface of webviz.sources.Source

    @property
    def graph(self) -> Graph:
        """For output."""
        return self.live.graph

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these, also of the live source.

        While rewound, that is not asked to repeat what is latched: the memory has it.
        """
        before, self._wanted = self._wanted, dict(subscriptions)  # with their lookbacks
        is_same = self._wanted == before
        if not is_same:
            self._told = {topic: self._passed_on(topic, w) for topic, w in subscriptions.items()}
            self._asked = {topic: self._asked[topic] for topic in subscriptions}
        self.live.want(self._with_log(self._told))
        if self._replay is None or is_same:
            return
        served, self._served = self._served, {}
        for topic, subscription in self._wanted.items():
            known = before.get(topic)
            asked = known.asked if known is not None and known.type == subscription.type else -1
            if asked < subscription.asked and served.get(topic) != subscription.type:
                self._repeat(topic, subscription, is_new=asked < 0)
        if _types(before) != _types(self._wanted):
            self._replay.read_on(self._channels_to_read())

    @property
    def bridges(self) -> Sequence[Bridge]:
        """Those of the live source."""
        return self.live.bridges

    def offers(self) -> Mapping[str, Offer]:
        """Those of the live source; while rewound, they say why a topic may have no message."""
        live = self.live.offers()
        if self._replay is None:
            return live
        known, wanted, offers = self._offers
        if known is not live or wanted != self._wanted.keys():
            offers = {
                topic: replace(offer, begins=NOT_REMEMBERED) if topic in self._wanted else offer
                for topic, offer in live.items()
            }
            self._offers = live, set(self._wanted), offers
        return offers

    def now_ns(self) -> int:
        """ROS time at the position."""
        if self._replay is None:
            return self.live.now_ns()
        is_simulated = self.live.clock_messages() is not None
        past = self._replay.past
        assert isinstance(past, MemoryPast)
        return max(1, past.ros_time_ns(self._replay.position_ns, is_simulated))

    def clock_messages(self) -> int | None:
        """Those of the live source."""
        return self.live.clock_messages()

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic; raises ValueError."""
        return self.live.resolve(topic)

    def close(self) -> None:
        """Close the live source."""
        self.live.close()

    # Internal

    def _past(self) -> MemoryPast:
        """Return the messages that were held when it was rewound, and those since."""
        newest = self.memory.after(self._held[-1][1].arrived_s)
        return MemoryPast([*self._held, *newest], self._clock)

    def _note_runs(self, entries: Sequence[Entry]) -> None:
        """Note when frames have transforms, in those of some messages that are new."""
        known_s = self._runs_until_s
        for topic, raw in entries:
            self._runs_until_s = raw.arrived_s
            wanted = self._wanted.get(topic)
            if wanted is not None and wanted.type == TF and raw.arrived_s > known_s:
                is_static = topic.endswith(STATIC_TF)
                self._runs.read(raw.cdr, self._clock.stamp_ns(raw.arrived_s), is_static)

    def _catch_up_with_memory(self) -> None:
        """Read what has arrived since the memory was read."""
        replay = self._replay
        if replay is None or not replay.is_exhausted or self.memory.newest_s is None:
            return
        if self._clock.stamp_ns(self.memory.newest_s) > replay.past.end_ns:
            replay.past = self._past()
            replay.read_on(self._channels_to_read())

    def _become_live(self) -> None:
        replay, self._replay = self._replay, None
        after_s = None if replay is None else self._clock.arrived_s(replay.position_ns)
        self.inbox.rejoin(lambda: () if after_s is None else self.memory.after(after_s))
        self._held, self._served = [], {}
        self._histogram.release()

    def _channels_to_read(self) -> list[MemoryChannel]:
        """Return the subscribed channels that are remembered as this type."""
        return [
            MemoryChannel(topic, subscription.type)
            for topic, subscription in self._wanted.items()
            if (channel := self.channels.find(topic)) and channel.type == subscription.type
        ]

    def _repeat(self, topic: str, subscription: Subscription, is_new: bool) -> None:
        """Deliver what a new subscription would hold, or what is latched for one made anew."""
        replay, latched = self._replay, self.channels.latched(topic)
        channels = [channel for channel in self._channels_to_read() if channel.topic == topic]
        lookbacks = subscription.lookbacks if is_new else ()
        if latched:
            lookbacks = (
                *lookbacks,
                Lookback() if subscription.latched else Lookback(count=latched),
            )
        if replay is None or not channels or not lookbacks:
            return
        wanted = {**self._wanted, topic: replace(subscription, lookbacks=lookbacks)}
        for message in BagPast(replay.past, channels, wanted, replay.position_ns).messages():
            self._deliver(message)

    def _with_log(self, told: Mapping[str, Subscription]) -> Mapping[str, Subscription]:
        """Return these and the log of all nodes, if a memory needs it and no other reads it."""
        offer = self.live.offers().get(ROSOUT)
        is_offered = offer is not None and any(each.type == LOG for each in offer.publishers)
        if not self.memory.is_on or ROSOUT in told or not is_offered:
            return told
        # What was logged before is not of the time at which it would be received.
        return {**told, ROSOUT: Subscription(LOG, Topic(ROSOUT, durability="volatile"))}

    def _passed_on(self, topic: str, subscription: Subscription) -> Subscription:
        """Return a subscription for the live source, which repeats nothing during the past."""
        asked, told = self._asked.get(topic, (-1, -1))
        is_repeated = asked >= 0 and (subscription.asked == asked or self._replay is not None)
        told = told if is_repeated else subscription.asked
        self._asked[topic] = subscription.asked, told
        return replace(subscription, asked=told)

    def _deliver(self, message: MemoryMessage) -> None:
        self.inbox.replay(message.topic, Raw(message.cdr, message.received_ns))


def _types(subscriptions: Mapping[str, Subscription]) -> dict[str, str]:
    return {topic: subscription.type for topic, subscription in subscriptions.items()}
