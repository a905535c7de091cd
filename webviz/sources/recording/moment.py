"""The memory of live topics as it is at one moment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from webviz.sources.past_state import Event
from webviz.sources.recording.entries_history import EntriesHistory
from webviz.sources.recording.memory import MemoryHistory
from webviz.sources.recording.recent import Entry


class MomentHistory(EntriesHistory):
    """All that is in memory when it is made, as a recording.

    It has the messages of the memory, not copies of them, and keeps them for as long as it is used.

    It is made on the frame loop of the memory, and read on another one once it was `prepared`.

    Args:
        memory: has at least one message.
    """

    is_growing = False
    names = ("Memory",)
    gap_ns = counted_ns = None

    def __init__(self, memory: MemoryHistory) -> None:
        super().__init__(memory.live, memory.recorded_channels, memory.clock)
        self._batch: Sequence[Entry] = memory.entries()
        first, last = self._batch[0][1], self._batch[-1][1]
        self.origin_ns = self.start_ns = self.clock.stamp_ns(first.arrived_s)
        self.last_ns = self.end_ns = self.clock.stamp_ns(last.arrived_s)
        self._logged = memory.logged()
        self._counts: tuple[int, Mapping[str, Sequence[int]]] = 0, {}

    def prepared(self) -> MomentHistory:
        """Sort the messages, which takes a while."""
        pending, self._batch = self._batch, ()
        self._add(pending)
        return self

    def refresh(self) -> bool:
        """`History.refresh`: nothing comes."""
        return False

    def histogram(self, parts: int) -> Mapping[str, Sequence[int]]:
        """`History.histogram`."""
        if self._counts[0] != parts:
            part_ns = max(self.last_ns - self.start_ns, 1) / parts
            counts: dict[str, list[int]] = {}
            for topic, raw in self._entries:
                passed_ns = self.clock.stamp_ns(raw.arrived_s) - self.start_ns
                own = counts.setdefault(topic, [0] * parts)
                own[min(int(passed_ns / part_ns), parts - 1)] += 1
            self._counts = parts, counts
        return self._counts[1]

    def logged(self) -> Sequence[Event]:
        """`History.logged`."""
        return self._logged
