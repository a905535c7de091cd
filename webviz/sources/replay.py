"""Playing of past messages: the position, and delivery of what was recorded until then."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Generic

from webviz.sources.bag.past import BagPast, C, M, PastMessages
from webviz.sources.bag.transform_runs import Runs
from webviz.sources.source import Subscription

MAX_BATCH = 500
"""Messages per call of `play`, so that no queue of the inbox overflows."""
MAX_BATCH_BYTES = 32 << 20
STEP_NS, LONG_STEP_NS = 100_000_000, 2_000_000_000
"""Recording time between two turns of a frame loop that draws nothing: longer while it is far from
its destination, but much shorter than the history of transforms."""


class Replay(Generic[C, M]):
    """Delivers the messages of a past in order.

    Args:
        past: where they are; may be replaced by one that has more of them.
        deliver: called with each message.
    """

    def __init__(self, past: PastMessages[C, M], deliver: Callable[[M], object]) -> None:
        self.past = past
        self._deliver = deliver
        self.position_ns = past.start_ns - 1
        """Everything recorded until then was delivered."""
        self._next: M | None = None
        self._upcoming: Iterator[M] = iter(())

    @property
    def is_exhausted(self) -> bool:
        """Return whether everything that was read is delivered."""
        return self._next is None

    @property
    def next_ns(self) -> int:
        """The time of the next message to deliver; that of the end after the last one."""
        return self.past.end_ns if self._next is None else self._next.stamp_ns

    def play(self, until_ns: int) -> None:
        """Deliver everything recorded until a time, or a part of it that an inbox can hold."""
        count = size = 0
        while self._next is not None and self._next.stamp_ns <= until_ns:
            # Messages of one stamp arrive together. Stamps in a file may be slightly out of order.
            is_later = self._next.stamp_ns > self.position_ns
            if is_later and (count >= MAX_BATCH or size >= MAX_BATCH_BYTES):
                return
            self.position_ns = max(self.position_ns, self._next.stamp_ns)
            self._deliver(self._next)
            count, size = count + 1, size + len(self._next.cdr)
            self._next = next(self._upcoming, None)
        self.position_ns = max(self.position_ns, until_ns)

    def play_step(self, until_ns: int) -> None:
        """Play a short step towards a time, or up to the next message if that is later."""
        next_ns = until_ns if self._next is None else self._next.stamp_ns
        left_ns = until_ns - self.position_ns
        step_ns = min(max(left_ns // 8, STEP_NS), LONG_STEP_NS)
        self.play(min(until_ns, max(next_ns, self.position_ns + step_ns)))

    def seek(
        self,
        at_ns: int,
        channels: Collection[C],
        wanted: Mapping[str, Subscription],
        runs: Runs | None = None,
    ) -> None:
        """Go to where playing leads to a time: to the first message that subscriptions need.

        Args:
            at_ns: the time of recording.
            channels: those to read.
            wanted: the subscriptions by topic.
            runs: when frames have transforms, as far as that is known.
        """
        needed = BagPast(self.past, channels, wanted, at_ns, runs).messages()
        self._upcoming = itertools.chain(needed, self.past.messages(channels, at_ns + 1))
        self._next = next(self._upcoming, None)
        first_ns = at_ns if self._next is None else self._next.stamp_ns
        self.position_ns = min(first_ns, at_ns) - 1

    def read_on(self, channels: Collection[C]) -> None:
        """Deliver the messages of these channels from the position on."""
        self._upcoming = self.past.messages(channels, self.position_ns + 1)
        self._next = next(self._upcoming, None)

    def neighbour(self, channels: Collection[C], is_forward: bool) -> int | None:
        """Return the time of the next or previous message of some channels.

        See `Playable.neighbour`.
        """
        if is_forward:
            found = next(self.past.messages(channels, self.position_ns + 1), None)
        else:
            before_ns = min(self.position_ns, self.past.end_ns) - 1
            found = next(self.past.newest(channels, before_ns), None)
        return None if found is None else found.stamp_ns
