"""Pacing of large topics on the link to a bridge, so that small ones are not late.

A bridge writes the messages of a connection one after the other: what is behind a cloud waits for
all of it, and what the link does not take waits in a queue of a thousand messages. Hence large
topics have a connection of their own. It is read at a rate that leaves the link without a queue,
which is seen by the delays of small messages (as in LEDBAT, RFC 6817), and while the link takes
less than is published, its topics are subscribed to one at a time, each for about one message.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Mapping

import msgspec

from webviz.sources.source import Subscription

LARGE_TYPES = frozenset(
    (
        "sensor_msgs/msg/PointCloud2",
        "sensor_msgs/msg/PointCloud",
        "sensor_msgs/msg/Image",
        "sensor_msgs/msg/CompressedImage",
        "nav_msgs/msg/OccupancyGrid",
        "map_msgs/msg/OccupancyGridUpdate",
        "grid_map_msgs/msg/GridMap",
        "octomap_msgs/msg/Octomap",
    )
)
"""Types with a connection of their own before the first message; others once one is large."""
LARGE = 48 << 10
"""Bytes of a large message."""
TF_TYPE = "tf2_msgs/msg/TFMessage"
PICTURE_TYPES = frozenset(("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"))
STREAMED_TYPES = frozenset(("nav_msgs/msg/OccupancyGrid", "map_msgs/msg/OccupancyGridUpdate"))
"""Types that are not thinned: each subscription would bring a whole map again."""
FIRST_RATE, MIN_RATE, MAX_RATE = 250e3, 4e3, 100e6
"""Bytes a second of large topics: at first, at least, and from which on nothing limits them."""
STEP_S = 0.2
"""Step in seconds between two changes of the rate."""
HIGH_S, LOW_S = 0.07, 0.04
"""Delay of small messages from which the rate falls, and below which it grows."""
DOWN, UP = 0.7, 1.1
SAMPLES_S = 0.5
"""Time in seconds for which the delay of a message counts. The least of these is that of the queue,
as in CoDel (RFC 8289): lost packets and busy computers delay some messages, a queue all."""
SPAN_S = 0.3
"""Time in seconds that delays span before they count: after a stall, many come at one moment."""
STUCK_S = 1.0
"""Time in seconds with late messages but few large ones, after which a topic moves to these."""
FIRST_STAY_S, MAX_STAY_S = 10.0, 300.0
"""Time in seconds for which it stays there at least; twice as long the next time."""
BEHIND_S = 1.0
"""Delay of large messages from which their topics take turns."""
SPARE = 0.6
"""Share of the rate that the topics may need for all to be subscribed to at once."""
FIRST_WINDOW_S = 0.1
CHUNK = 8 << 10
"""Bytes that may come at once, at a low rate after a long time."""
WIDER, NARROWER = 1.5, 0.8
"""Factors of a window that brought nothing, and of one that brought several messages."""
RARE_S = 1.0
"""Time in seconds between two messages of a topic that stays subscribed to."""
UNKNOWN_SIZE, EMPTY_TURN = 256 << 10, 64 << 10
"""Bytes that count for a message before the first one, and for a turn without any."""
LEAST_TRANSFER_S = 0.002
ANSWER_S = 0.5
"""Besides a round trip, after which a subscription has brought nothing."""
SHOWN_S = 2.0
"""Time in seconds for which topics take turns before that is reported."""
RECENT_S = 5.0
"""Time in seconds for which rates are measured."""


def is_thinnable(subscription: Subscription) -> bool:
    """Return whether messages may be left out, since each is shown alone."""
    if subscription.type in PICTURE_TYPES:
        return True  # displays of images also read video, of which each needs those before
    return subscription.type not in STREAMED_TYPES | {TF_TYPE} and all(
        (each.count or each.seconds) and not (each.since or each.starts_over or each.chooses)
        for each in subscription.lookbacks
    )


class Flow(msgspec.Struct):
    """A topic whose messages are large, or do not fit among the small ones.

    Args:
        size: bytes of its last message, 0 before the first.
        window_s: for how long a subscription brings about one message.
    """

    size: float
    window_s: float = FIRST_WINDOW_S
    sent_bytes: float = 0.0
    """Bytes that were received in turns, by which topics are chosen."""
    digest: int = 0
    is_kept: bool = False
    """True if it stays subscribed to: a new subscription has brought the same message again, so it
    is latched; or messages are rare."""
    count: int = 0
    """Messages of the last turn."""
    arrived: deque[float] = msgspec.field(default_factory=lambda: deque(maxlen=10))
    """Moments of the last arrivals."""

    @property
    def need(self) -> float:
        """Bytes a second that are published, estimated."""
        return 0.0 if self.is_kept else self.size / self.window_s


class RateController:
    """Decides which topics are subscribed to, and how fast those with large messages are read.

    All moments are monotonic times in seconds.
    """

    def __init__(self) -> None:
        self.rate = FIRST_RATE
        """Bytes a second at which large topics are read."""
        self.is_in_turns = True
        """True while topics are subscribed to one at a time."""
        self._is_starting = True
        self._changed_s = 0.0
        self._stuck_s: float | None = None
        self._delays: deque[tuple[float, float]] = deque()
        self._bytes: deque[tuple[float, int, bool]] = deque()
        """Moment, size, and whether it was of a large topic."""
        self._small: dict[str, deque[tuple[float, int]]] = {}
        self._moved: set[str] = set()
        """Topics that are not small, though their types are."""
        self._flows: dict[str, Flow] = {}
        self._turn = ""
        """The topic whose turn it is."""
        self._turn_s = 0.0
        self._is_open = False
        """True while it is subscribed to."""
        self._heard_s = 0.0
        """The last byte of a large topic."""
        self._burst: tuple[float, int, float] = 0.0, 0, 0.0
        """Moment of the first byte, bytes, and the rate then, since the last large message."""
        self.trip_s = 0.0
        """The shortest round trip."""
        self._thin: dict[str, bool] = {}
        self._back_s, self._stay_s = 0.0, FIRST_STAY_S
        """The moment before which no topic moves back, and for how long the next stays."""
        self._speed = 0.0
        """Bytes a second of the last large message."""
        self._limited_s = 0.0
        """The last message that came as fast as the rate allows."""
        self._turns_s = 0.0
        """The beginning of the turns."""
        self._last_state: tuple[set[str], int] = set(), 0
        """The last decision of `step`, which messages change in between."""

    # Subscriptions

    def large(self, subscriptions: Mapping[str, Subscription]) -> dict[str, Subscription]:
        """Return the subscriptions with large messages, and forget the flows of others."""
        large = {
            t: w for t, w in subscriptions.items() if w.type in LARGE_TYPES or t in self._moved
        }
        self._moved &= subscriptions.keys()
        self._thin = {topic: is_thinnable(subscription) for topic, subscription in large.items()}
        least_taken = min((flow.sent_bytes for flow in self._flows.values()), default=0.0)
        sizes = {topic: moments[-1][1] for topic, moments in self._small.items()}
        self._flows = {
            topic: self._flows.get(topic) or Flow(size=sizes.get(topic, 0), sent_bytes=least_taken)
            for topic in large
        }
        self._small = {
            t: d for t, d in self._small.items() if t in subscriptions and t not in large
        }
        if self._turn not in large:
            self._turn = ""
        return large

    def subscribed(self) -> Collection[str]:
        """Return the large topics that are subscribed to now."""
        if not self.is_in_turns:
            return self._flows.keys()
        always = {t for t, f in self._flows.items() if f.is_kept or not self._thin[t]}
        return always | ({self._turn} if self._turn and self._is_open else set())

    def is_thinned(self, topic: str) -> bool:
        """Return whether messages of a large topic are left out now."""
        return self.is_in_turns and self._thin.get(topic, False)

    # Observations

    def note_small(self, topic: str, type: str, size: int, delay_s: float, now_s: float) -> bool:
        """Note a message among the small ones; whether its topic is a large one from now on."""
        self._delays.append((now_s, delay_s))
        self._bytes.append((now_s, size, False))
        if type == TF_TYPE:
            return False
        self._small.setdefault(topic, deque(maxlen=100)).append((now_s, size))
        if size < LARGE or topic in self._moved:
            return False
        self._moved.add(topic)
        return True

    def note_trip(self, seconds: float, least_s: float, now_s: float) -> None:
        """Note a round trip, which waits for small messages, too."""
        self.trip_s = least_s
        self._delays.append((now_s, seconds - least_s))

    def note_bytes(self, size: int, now_s: float) -> None:
        """Note bytes of large topics."""
        self._heard_s = now_s
        self._bytes.append((now_s, size, True))
        began_s, count, rate = self._burst
        self._burst = (began_s, count + size, rate) if count else (now_s, size, self.rate)

    def note_large(self, topic: str, cdr: bytes, delay_s: float, now_s: float) -> None:
        """Note a message of a large topic."""
        flow = self._flows.get(topic)
        if flow is None:
            return
        rested_s = now_s - flow.arrived[-1] if flow.arrived else math.inf
        flow.arrived.append(now_s)
        flow.size = len(cdr)
        # A turn takes a round trip, too, in which others could have had the link.
        flow.sent_bytes += max(len(cdr), min(self.rate * self.trip_s, UNKNOWN_SIZE))
        digest = hash(cdr)
        if flow.is_kept and rested_s < RARE_S:
            flow.is_kept = False
        elif digest == flow.digest and self.is_in_turns and flow.count == 0:
            flow.is_kept = True
        flow.digest = digest
        flow.count += 1
        (began_s, count, rate), self._burst = self._burst, (now_s, 0, self.rate)
        if count > LARGE:  # the link may take less than the rate, without any queue
            speed = self._speed = count / (now_s - began_s + LEAST_TRANSFER_S)
            if speed < min(rate, self.rate) / 2:  # the rate may have grown meanwhile
                self._is_starting, self.rate = False, max(MIN_RATE, 1.5 * speed)
            else:
                self._limited_s = now_s
        if not self.is_in_turns and delay_s > BEHIND_S:
            self.rate = max(MIN_RATE, min(self.rate, self._used(now_s)))
            self._begin_turns()

    # Decisions

    def step(self, now_s: float) -> bool:
        """Decide anew; whether other topics are subscribed to than before, or others are large."""
        self._forget(now_s)
        if now_s - self._changed_s >= STEP_S:
            self._changed_s = now_s
            self._choose_rate(now_s)
        self._take_turns(now_s)
        before, self._last_state = self._last_state, (set(self.subscribed()), len(self._moved))
        return self._last_state != before

    @property
    def late_s(self) -> float:
        """Delay of small messages, in seconds."""
        return min((delay for _, delay in self._delays), default=0.0)

    def carried(self) -> float:
        """Return the bytes a second that arrived lately, of all topics."""
        return sum(size for _, size, _ in self._bytes) / RECENT_S

    def thinned(self, now_s: float) -> dict[str, float]:
        """Return the rates of the topics that take turns, in Hz; without what is not late."""
        if not self.is_in_turns or now_s - self._turns_s < SHOWN_S:
            return {}
        return {
            topic: _rate(flow.arrived, now_s)
            for topic, flow in self._flows.items()
            if self._thin[topic] and not flow.is_kept and flow.arrived
        }

    def _choose_rate(self, now_s: float) -> None:
        if not self._delays or now_s - self._delays[0][0] < SPAN_S:
            return
        late_s, used = self.late_s, self._used(now_s)
        if late_s <= HIGH_S:
            self._stuck_s = None
        if late_s < LOW_S and (
            self._is_starting or used > self.rate / 2 or now_s - self._limited_s < 2 * STEP_S
        ):
            self.rate = min(MAX_RATE, self.rate * (2.0 if self._is_starting else UP))
        elif late_s > HIGH_S and used > 2 * MIN_RATE:
            self._is_starting = False
            self.rate = max(MIN_RATE, min(self.rate, max(used, self._speed)) * DOWN)
            if not self.is_in_turns:
                self._begin_turns()
            self._delays.clear()  # what follows shows what the change does
            self._changed_s += self.trip_s
        elif late_s > HIGH_S and self._stuck_s is None:
            self._stuck_s = now_s
        elif late_s > HIGH_S and self._stuck_s and now_s - self._stuck_s > STUCK_S:
            self._stuck_s = None
            self._move_largest(now_s)
        self._move_back(now_s)

    def _used(self, now_s: float) -> float:
        """Return the bytes of large topics in the last second."""
        return sum(size for at_s, size, large in self._bytes if large and now_s - at_s < 1.0)

    def _move_largest(self, now_s: float) -> None:
        """Let the topic with the most bytes take turns with the large ones."""
        rates = {
            topic: sum(size for at_s, size in sizes if now_s - at_s < RECENT_S)
            for topic, sizes in self._small.items()
            if topic not in self._moved
        }
        if rates and max(rates.values()):
            self._moved.add(max(rates, key=rates.__getitem__))
            self._back_s = now_s + self._stay_s
            self._stay_s = min(MAX_STAY_S, 2 * self._stay_s)

    def _move_back(self, now_s: float) -> None:
        """Let topics that were moved go again without turns, once they seem to fit."""
        small = {t for t in self._moved if t in self._flows and self._flows[t].size < LARGE}
        if small and now_s > self._back_s and self.late_s < LOW_S:
            need = sum(self._flows[topic].need for topic in small)
            if need < SPARE * self.rate:
                self._moved -= small

    def _begin_turns(self) -> None:
        self.is_in_turns, self._turns_s = True, self._changed_s
        self._turn = ""
        for flow in self._flows.values():
            flow.sent_bytes = 0.0

    def _take_turns(self, now_s: float) -> None:
        """End a turn that has brought its message or nothing, and begin the next."""
        if not self.is_in_turns or not self._waiting():
            return
        flow = self._flows.get(self._turn)
        if flow is not None and not flow.is_kept:
            if flow.count or now_s - self._turn_s >= flow.window_s:
                self._is_open = False
            if self._is_open:
                return
            is_coming = self._is_coming(flow, now_s) and self._next() != self._turn
            if not flow.count and not is_coming:
                if self._may_come(flow, now_s):
                    return
                flow.window_s *= WIDER
                flow.is_kept = flow.window_s > RARE_S
                flow.sent_bytes += EMPTY_TURN
            if self._has_room():
                self.is_in_turns = False
                self._moved -= {t for t, f in self._flows.items() if f.size < LARGE}
                return
        self._turn = self._next()
        if flow := self._flows.get(self._turn):
            if flow.count > 1:
                flow.window_s *= NARROWER
            flow.count = 0
            self._turn_s, self._is_open = now_s, True

    def _waiting(self) -> list[str]:
        """Return the topics that take turns."""
        return [t for t, f in self._flows.items() if self._thin[t] and not f.is_kept]

    def _next(self) -> str:
        """Return the topic that will have received the least with its next message."""

        def finish(topic: str) -> float:
            flow = self._flows[topic]
            is_coming = topic == self._turn and not flow.count
            return flow.sent_bytes + (flow.size or UNKNOWN_SIZE) * (2 if is_coming else 1)

        return min(self._waiting(), key=finish, default="")

    def _is_coming(self, flow: Flow, now_s: float) -> bool:
        """Return whether so much of a message has come that the next is asked for in time."""
        began_s, count, _ = self._burst
        speed = count / (now_s - began_s + LEAST_TRANSFER_S)
        return 0 < flow.size - count < speed * (self.trip_s + flow.window_s)

    def _may_come(self, flow: Flow, now_s: float) -> bool:
        """Return whether a message may be under way still."""
        silent_s = now_s - max(self._heard_s, self._turn_s + flow.window_s)
        return silent_s < self.trip_s + ANSWER_S + CHUNK / self.rate

    def _has_room(self) -> bool:
        """Return whether all topics fit, of which each has brought a message."""
        flows = [self._flows[topic] for topic in self._waiting()]
        need = sum(flow.need for flow in flows)
        return all(flow.size for flow in flows) and need < SPARE * self.rate

    def _forget(self, now_s: float) -> None:
        while self._delays and now_s - self._delays[0][0] > SAMPLES_S:
            self._delays.popleft()
        while self._bytes and now_s - self._bytes[0][0] > RECENT_S:
            self._bytes.popleft()


def _rate(arrived: deque[float], now_s: float) -> float:
    """Return messages per second, from the last ones to now."""
    spent_s = now_s - arrived[0]
    return (len(arrived) - 1 or 1) / spent_s if spent_s > 0 else math.inf
