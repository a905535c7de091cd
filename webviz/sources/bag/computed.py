"""Messages that are in no file, as one of the files of a bag."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from webviz.data.recordings.recording import Counts, TimeParts
from webviz.sources.bag.file import BagChannel
from webviz.sources.history import Recorded

Times = npt.NDArray[np.int64]
"""Times of recording in ns, increasing."""
Serialized = Callable[[int], bytes]
"""Returns the message of a number."""


class ComputedFile:
    """Computed messages; see `webviz.sources.bag.file.BagFile`.

    Args:
        messages: times and messages by channel, one of a topic; not empty.
    """

    name = ""
    warnings: Sequence[str] = ()

    def __init__(self, messages: Mapping[BagChannel, tuple[Times, Serialized]]) -> None:
        self._messages = {channel.topic: content for channel, content in messages.items()}
        self.channels = tuple(messages)
        self.start_ns = min(int(times[0]) for times, _ in messages.values())
        self.end_ns = max(int(times[-1]) for times, _ in messages.values())
        self.skipped: dict[str, str] = {}

    def messages(
        self, channels: Collection[BagChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """See `BagFile.messages`."""
        until_ns = self.end_ns if end_ns is None else end_ns
        streams = [self._of_channel(channel, start_ns, until_ns) for channel in channels]
        return heapq.merge(*streams, key=_stamp)

    def newest(self, channels: Collection[BagChannel], end_ns: int) -> Iterator[Recorded]:
        """See `BagFile.newest`."""
        streams = [
            self._of_channel(channel, self.start_ns, end_ns, step=-1) for channel in channels
        ]
        return heapq.merge(*streams, key=_stamp, reverse=True)

    def newest_stamps(self, channels: Collection[BagChannel], end_ns: int) -> Iterator[int]:
        """See `BagFile.newest_stamps`."""
        return map(_stamp, self.newest(channels, end_ns))

    def is_used(self, channel: BagChannel) -> bool:
        """Return True."""
        return True

    def histogram(self, parts: TimeParts) -> dict[str, Counts]:
        """See `BagFile.histogram`."""
        return {
            topic: np.bincount(parts.part_of(times.astype(np.uint64)), minlength=parts.count)
            for topic, (times, _) in self._messages.items()
        }

    def close(self) -> None:
        """Do nothing."""

    def _of_channel(
        self, channel: BagChannel, start_ns: int, end_ns: int, step: int = 1
    ) -> Iterator[Recorded]:
        """Yield the messages of a channel in a span of time, both ends included."""
        times, serialized = self._messages[channel.topic]
        first, last = np.searchsorted(times, start_ns), np.searchsorted(times, end_ns, "right")
        for number in range(first, last)[::step]:
            cdr = serialized(number)
            yield Recorded(channel.topic, channel.type, cdr, int(times[number]))


def _stamp(recorded: Recorded) -> int:
    return recorded.stamp_ns
