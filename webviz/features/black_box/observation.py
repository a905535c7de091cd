"""Things that rules are about: statuses of displays, and rates and levels of topics."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Collection, Mapping, Sequence

import msgspec

from webviz.api.status import Level
from webviz.data.messages import MessageError, decode
from webviz.engine.path_numbers import PathNumbers
from webviz.sources import Raw

SPAN_S = 3.0
"""Time in seconds over which a rate is measured."""
LEVEL_S = 2.0
"""Duration for which the level of a message counts."""
MAX_UNREAD = 20
"""Messages of a topic whose numbers are not read yet; of more, the last count."""
MAX_WAITING = 100
"""Messages of a topic whose level is not read yet."""
DIAGNOSTICS, LOG = "diagnostic_msgs/msg/DiagnosticArray", "rcl_interfaces/msg/Log"
LEVEL_TYPES = (DIAGNOSTICS, LOG)
LOG_WARN, LOG_ERROR = 30, 40


class WatchedMoment(msgspec.Struct, frozen=True):
    """A moment, as far as rules are about it.

    Args:
        at_s: monotonic time in seconds.
        displays: levels by name; of several displays of a name, the worst.
        rates: messages per second by topic, of those that were received long enough.
        levels: the worst level of the last messages by topic.
        numbers: those that paths name, by path: of the messages since the last moment, or else of
            the last ones.
        conditions: whether the conditions of rules hold, by their text; None while that is unknown.
    """

    at_s: float
    displays: Mapping[str, Level] = msgspec.field(default_factory=dict)
    rates: Mapping[str, float] = msgspec.field(default_factory=dict)
    levels: Mapping[str, Level] = msgspec.field(default_factory=dict)
    numbers: Mapping[str, Sequence[float]] = msgspec.field(default_factory=dict)
    conditions: Mapping[str, bool | None] = msgspec.field(default_factory=dict)


class TopicObserver:
    """Measures the rates of topics, and reads the levels of messages; `put` from any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._counted: Collection[str] = ()
        self._leveled: Mapping[str, str] = {}
        self._arrivals: dict[str, deque[float]] = {}
        self._first: dict[str, float] = {}
        self._waiting: dict[str, deque[Raw]] = {}
        self._levels: dict[str, tuple[float, Level]] = {}
        self._typed: Mapping[str, str] = {}
        self._paths: dict[str, PathNumbers] = {}
        self._unread: dict[str, deque[Raw]] = {}

    def observe(
        self,
        counted: Collection[str],
        leveled: Mapping[str, str],
        paths: Mapping[str, str] | None = None,
    ) -> None:
        """Observe exactly these topics.

        Args:
            counted: those whose rate is measured.
            leveled: types by topic, of those whose levels are read.
            paths: types by message path, of those whose numbers are read.
        """
        self._typed = paths or {}
        if self._paths.keys() != self._typed.keys():
            former = self._paths
            self._paths = {text: former.get(text) or PathNumbers(text) for text in self._typed}
        topics = {each.path.topic for each in self._paths.values()}
        with self._lock:
            self._counted, self._leveled = counted, leveled
            for topic in self._unread.keys() - topics:
                del self._unread[topic]
            for topic in topics:
                self._unread.setdefault(topic, deque(maxlen=MAX_UNREAD))
            for table in (self._arrivals, self._first):
                for removed in table.keys() - set(counted):
                    del table[removed]
            for table in (self._waiting, self._levels):
                for removed in table.keys() - leveled.keys():
                    del table[removed]

    def put(self, topic: str, raw: Raw) -> None:
        """Note a message."""
        if topic in self._counted:
            with self._lock:
                self._first.setdefault(topic, raw.arrived_s)
                arrivals = self._arrivals.setdefault(topic, deque())
                arrivals.append(raw.arrived_s)
                while arrivals[0] < raw.arrived_s - SPAN_S:
                    arrivals.popleft()
        if (unread := self._unread.get(topic)) is not None:
            unread.append(raw)
        if topic in self._leveled:
            with self._lock:
                self._waiting.setdefault(topic, deque(maxlen=MAX_WAITING)).append(raw)

    def rates(self, now_s: float) -> dict[str, float]:
        """Messages per second, of topics that were received for long enough to know it."""
        with self._lock:
            return {
                topic: sum(at_s > now_s - SPAN_S for at_s in self._arrivals[topic]) / SPAN_S
                for topic, first_s in self._first.items()
                if now_s - first_s >= SPAN_S
            }

    def levels(self, now_s: float) -> dict[str, Level]:
        """Return the worst level of the messages of the last seconds; OK if there was none."""
        with self._lock:
            waiting, self._waiting = self._waiting, {}
            types = self._leveled
        for topic, raws in waiting.items():
            for raw in raws:
                level = _level(types.get(topic, ""), raw)
                at_s, worst = self._levels.get(topic, (0.0, Level.OK))
                if level >= worst or raw.arrived_s - at_s > LEVEL_S:
                    self._levels[topic] = raw.arrived_s, level
        return {
            topic: level if now_s - at_s <= LEVEL_S else Level.OK
            for topic, (at_s, level) in self._levels.items()
        }

    def numbers(self) -> dict[str, Sequence[float]]:
        """Return the numbers of paths, of those that were found so far."""
        batches: dict[str, list[Raw]] = {}
        for topic, unread in self._unread.items():
            batches[topic] = [unread.popleft() for _ in range(len(unread))]
        for text, each in self._paths.items():
            if batch := batches[each.path.topic]:
                each.read(self._typed[text], batch)
        return {text: each.numbers for text, each in self._paths.items() if each.numbers}


def _level(type_name: str, raw: Raw) -> Level:
    """Return the level of a message; OK of one that cannot be read."""
    try:
        if type_name == DIAGNOSTICS:
            array = decode(DIAGNOSTICS, raw.cdr, raw.types)
            worst = max((status.level for status in array.status), default=0)
            return (Level.OK, Level.WARN)[worst] if worst < 2 else Level.ERROR
        log = decode(LOG, raw.cdr, raw.types)
    except MessageError:
        return Level.OK
    if log.level >= LOG_ERROR:
        return Level.ERROR
    return Level.WARN if log.level >= LOG_WARN else Level.OK
