"""Times of the messages before those that a seek reads, for the statistics of their topics."""

from __future__ import annotations

import itertools
from collections.abc import Collection
from dataclasses import replace

from webviz.sources.bag.file import BagChannel, Recorded
from webviz.sources.bag.files import BagFiles
from webviz.sources.bag.time import CLOCK, TF
from webviz.sources.inbox import Earlier

LAST = 100
"""Messages of a topic whose times are known."""


class EarlierMessages:
    """Knows the last messages of topics until a position, until their next one is delivered.

    Args:
        file: the bags.
    """

    def __init__(self, file: BagFiles) -> None:
        self._file = file
        self._first_ns: dict[str, int] = {}
        self._known: dict[str, Earlier] = {}

    def note_first(self, first: Recorded) -> None:
        """Note the first message of a topic."""
        self._first_ns[first.topic] = first.stamp_ns

    def look(self, channels: Collection[BagChannel], at_ns: int, *, is_new: bool) -> None:
        """Look up the last messages of channels until a time of recording.

        Args:
            channels: those of transforms and of the clock are ignored.
            at_ns: the time.
            is_new: whether this replaces what is known of topics.
        """
        for topic in {each.topic for each in channels if each.type not in (TF, CLOCK)}:
            if topic in self._known and not is_new:
                continue
            own = [channel for channel in channels if channel.topic == topic]
            stamps = list(itertools.islice(self._file.newest_stamps(own, at_ns), LAST))
            if stamps:
                first_ns = self._first_ns.get(topic, stamps[-1])
                self._known[topic] = Earlier(stamps, first_ns)

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
