"""Times of the messages before those that a seek reads, for the statistics of their topics."""

from __future__ import annotations

import itertools
from collections.abc import Collection
from dataclasses import replace

from webviz.sources.history.history import FOLLOWED, History, HistoryChannel, Recorded
from webviz.sources.inbox import Earlier

LAST = 100
"""Messages of a topic whose times are known."""


class EarlierMessages:
    """Knows the last messages of topics until a position, until their next one is delivered.

    Args:
        history: all messages.
    """

    def __init__(self, history: History) -> None:
        self._history = history
        self._known: dict[str, Earlier] = {}

    def look(self, channels: Collection[HistoryChannel], at_ns: int, *, is_new: bool) -> None:
        """Look up the last messages of channels until a time of recording.

        Args:
            channels: one of a topic; those of transforms and of the clock are ignored.
            at_ns: the time.
            is_new: whether this replaces what is known of topics.
        """
        if self._history.is_growing:
            return
        for channel in channels:
            if channel.type in FOLLOWED or (channel.topic in self._known and not is_new):
                continue
            found = self._history.newest_stamps([channel], at_ns)
            stamps = list(itertools.islice(found, LAST))
            if stamps:
                first_ns = self._history.first_ns(channel)
                first_ns = stamps[-1] if first_ns is None else first_ns
                self._known[channel.topic] = Earlier(stamps, first_ns)

    def clear(self) -> None:
        """Forget what no message was delivered for."""
        self._known.clear()

    def take(self, recorded: Recorded) -> Earlier | None:
        """Return what came before a message, once it is the newest or follows that."""
        earlier, stamp_ns = self._known.get(recorded.topic), recorded.stamp_ns
        if earlier is None or stamp_ns < earlier.recorded_ns[0]:
            return None
        del self._known[recorded.topic]
        # Others of the same time are delivered with it.
        before = [each for each in earlier.recorded_ns if each < stamp_ns]
        return replace(earlier, recorded_ns=before)
