"""Counts of the messages in memory, for the timeline of live topics."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from webviz.sources.recording.recent import RecentMessages
from webviz.sources.recording.wall_clock import WallClock

NOT_COUNTED: Mapping[str, Sequence[int]] = {}
MAX_HELD_PARTS = 1000
"""Parts of which messages were forgotten meanwhile but are still shown."""


class LiveHistogram:
    """Messages by topic in equal parts of time; one that goes on is counted when it is over.

    Args:
        memory: of the messages.
        clock: for their times of recording.
    """

    def __init__(self, memory: RecentMessages, clock: WallClock) -> None:
        self._memory = memory
        self._clock = clock
        self._held: dict[str, Counter[int]] = {}
        self._held_part_s = 0.0
        self._key: object = None
        self._counts = NOT_COUNTED
        self.span_ns = (0, 0)
        """Times of recording that the counts are of."""

    def hold(self) -> None:
        """Keep the counts of all that is in memory now, until `release`."""
        self._held_part_s, self._held = self._memory.counts()

    def release(self) -> None:
        """Forget what is not in memory."""
        self._held = {}

    def counts(self, now_ns: int) -> Mapping[str, Sequence[int]]:
        """Messages by topic; the same mapping until a part is over.

        Args:
            now_ns: time of recording.
        """
        part_s, found = self._memory.counts() if self._memory.is_on else (1.0, {})
        if self._held and self._held_part_s == part_s:
            for topic, own in self._held.items():
                found[topic] = own | found.get(topic, Counter())  # the greater of each part
        end = int(self._clock.arrived_s(now_ns) // part_s)
        first = min((part for own in found.values() for part in own), default=end)
        first = max(first, end - MAX_HELD_PARTS)
        key = first, end, part_s, len(found)
        if key != self._key:
            self._key = key
            self.span_ns = self._clock.stamp_ns(first * part_s), self._clock.stamp_ns(end * part_s)
            self._counts = {
                topic: [own[part] for part in range(first, end)] for topic, own in found.items()
            }
        return self._counts
