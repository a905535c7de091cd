"""Warnings and errors that nodes log while topics are live."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from webviz.sources.bag.log import LEVEL_AT, LOG, MAX_EVENTS, ROSOUT, WARN, event_of
from webviz.sources.history import Recorded
from webviz.sources.inbox import Raw
from webviz.sources.past_state import Event
from webviz.sources.recording.wall_clock import WallClock


class LiveLog:
    """Keeps what was logged to /rosout; `put` is called from any thread.

    Args:
        clock: for times of recording.
    """

    def __init__(self, clock: WallClock) -> None:
        self._clock = clock
        self._new: deque[Raw] = deque(maxlen=MAX_EVENTS)
        self._events: deque[Event] = deque(maxlen=MAX_EVENTS)
        self._shown: Sequence[Event] = ()

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
            if found := event_of(Recorded(ROSOUT, LOG, raw.cdr, stamp_ns, raw.types)):
                events.append(found[1])
        while events and events[0].at_ns < start_ns:
            events.popleft()
            is_changed = True
        if is_changed:
            self._shown = tuple(events)
        return self._shown
