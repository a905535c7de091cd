"""Estimates of what a bridge dropped because its link is slower than its topics."""

from __future__ import annotations

from collections import deque

MOST = 50
"""Last messages of a topic from which its period is known."""
FEWEST = 5
BEHIND_S = 0.5
"""Delay beyond the least one, from which on a link is behind."""
WINDOW_S = 60.0
"""Time in seconds after which the least delay is forgotten, since clocks drift."""


class LinkDelay:
    """Delays of messages, compared with the fastest ones.

    The clocks of the bridge and of this machine may differ, so the least difference between arrival
    and stamp counts as no delay.
    """

    def __init__(self) -> None:
        self._least: deque[tuple[float, float]] = deque()
        """Moment and difference, ascending in both: the first is the least."""

    @property
    def least_s(self) -> float:
        """The least difference between arrival and stamp, once a message was noted."""
        return self._least[0][1]

    def note(self, stamp_s: float, now_s: float) -> float:
        """Note a message; its delay in seconds."""
        difference = now_s - stamp_s
        while self._least and self._least[-1][1] >= difference:
            self._least.pop()
        self._least.append((now_s, difference))
        while self._least[0][0] < now_s - WINDOW_S:
            self._least.popleft()
        return difference - self._least[0][1]


class TopicBacklog:
    """The messages of one topic, by the stamps of the bridge.

    A bridge with a full queue drops the oldest messages and does not say so. Its stamps then have
    gaps, while messages come late; a gap of a message that is not late is the publisher's.
    """

    def __init__(self) -> None:
        self._stamp_s: float | None = None
        self._periods: deque[float] = deque(maxlen=MOST)
        self.dropped = 0
        """Messages that were dropped, estimated."""
        self.delay_s = 0.0
        """Delay in seconds of the newest message."""

    def note(self, stamp_s: float, delay_s: float) -> None:
        """Note a message and its delay."""
        self.delay_s = delay_s
        before, self._stamp_s = self._stamp_s, stamp_s
        period = stamp_s - before if before is not None else 0.0
        if period <= 0.0:
            return
        usual = self._usual_s()
        if len(self._periods) >= FEWEST and delay_s > BEHIND_S and period > 1.5 * usual:
            self.dropped += round(period / usual) - 1
        elif delay_s <= BEHIND_S or len(self._periods) < FEWEST:
            self._periods.append(period)

    def _usual_s(self) -> float:
        """Return the mean period without pauses: several publishers may send at one moment."""
        periods = sorted(self._periods)[: -(-len(self._periods) * 9 // 10)]
        return sum(periods) / len(periods) if periods else 0.0
