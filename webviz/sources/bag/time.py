"""ROS time of a bag, if it differs from the time of recording."""

from __future__ import annotations

import copy
import itertools
from collections.abc import Iterator

from webviz.data.messages import Clock, MessageError, TFMessage, decode
from webviz.data.recordings.latched import TF
from webviz.sources.bag.files import BagFiles
from webviz.sources.history import CLOCK, Recorded

FOREIGN_NS = 3600 * 1_000_000_000
"""Transforms that are further from the time of recording are in simulated time."""
MAX_TRIED = 100


class BagTime:
    """Converts times of recording to ROS time, both in nanoseconds.

    A recorded /clock decides, as with use_sim_time; without one, the stamps of the first
    transforms do if all of them are more than an hour off. A slice begins with transforms of the
    time before, which say nothing.

    Args:
        file: the bags.
    """

    def __init__(self, file: BagFiles) -> None:
        self._file = file
        self.warning = ""
        """A warning, "" for none."""
        self._clocks = [c for c in file.channels if (c.topic, c.type) == ("/clock", CLOCK)]
        self._clock_ns: int | None = None
        self._offset_ns = 0
        self._first = next(file.messages(self._clocks, file.start_ns), None)
        if self._first is not None:
            self.take(self._first)
        else:
            self._follow_transforms(file)

    def seek(self, at_ns: int) -> None:
        """Go to a time of recording: its last /clock counts, or else the first one of the bag."""
        if self._first is not None:
            self.take(next(self._file.newest(self._clocks, at_ns), self._first))

    def copy(self) -> BagTime:
        """Return the same for another reader."""
        return copy.copy(self)

    def take(self, recorded: Recorded) -> None:
        """Process a message in the order of the bag; those of /clock set the time."""
        if recorded.type != CLOCK or recorded.topic != "/clock":
            return
        try:
            message: Clock = decode(CLOCK, recorded.cdr)
        except MessageError:
            return
        self._clock_ns = message.clock.ns

    def at(self, recorded_ns: int) -> int:
        """ROS time at a time of recording; with a /clock, its last message."""
        return recorded_ns - self._offset_ns if self._clock_ns is None else self._clock_ns

    def _follow_transforms(self, file: BagFiles) -> None:
        offsets: list[tuple[int, int]] = []
        starts = file.start_ns + 1, file.start_ns
        for recorded in itertools.chain.from_iterable(_first(file, start) for start in starts):
            try:
                message: TFMessage = decode(TF, recorded.cdr)
            except MessageError:
                continue
            stamps = [t.stamp_ns for t in message.transforms if t.stamp_ns]
            if not stamps:
                continue
            offsets.append((recorded.stamp_ns - stamps[0], stamps[0]))
            if abs(offsets[-1][0]) <= FOREIGN_NS:
                return
        if not offsets:
            return
        least_ns = min(abs(offset_ns) for offset_ns, _ in offsets)
        near = [each for each in offsets if abs(each[0]) - least_ns <= FOREIGN_NS]
        self._offset_ns = near[0][0]
        first_ns = min(stamp_ns for _, stamp_ns in near)
        self.warning = (
            f"The transforms begin at {first_ns / 1e9:.1f} s, which is not the time of "
            "recording, and there is no /clock: time follows the transforms."
        )


def _first(file: BagFiles, start_ns: int) -> Iterator[Recorded]:
    """Return the first transforms from a time of recording on."""
    channels = [c for c in file.channels if (c.topic, c.type) == ("/tf", TF)]
    return itertools.islice(file.messages(channels, start_ns), MAX_TRIED)
