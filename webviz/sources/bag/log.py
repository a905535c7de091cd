"""Warnings and errors that nodes logged to /rosout, read ahead of playing."""

from __future__ import annotations

import heapq
import random
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from pathlib import Path

import msgspec

from webviz.api.status import Level
from webviz.data.disk import in_thread
from webviz.data.messages import MessageError, decode
from webviz.data.words import shortened
from webviz.sources.bag.file import BagChannel
from webviz.sources.bag.files import BagFiles
from webviz.sources.history import Recorded
from webviz.sources.past_state import Event

ROSOUT, LOG = "/rosout", "rcl_interfaces/msg/Log"
WARN, ERROR = 30, 40
"""Levels of rcl_interfaces/msg/Log; FATAL is above."""
LEVEL_AT = 12
"""Offset of the level in CDR: the encapsulation header and a stamp precede it."""
ROS_1_LOG = "rosgraph_msgs/msg/Log"
ROS_1_LEVELS = {4: WARN, 8: ERROR, 16: 50}
"""Levels of rosgraph_msgs/Log that are shown, and those of rcl_interfaces/msg/Log."""
MAX_EVENTS = 1000
MAX_NAME, MAX_TEXT = 100, 200
"""Characters of a node's name and of the first line of its message."""
MAX_BYTES = 256 << 20
"""Bytes of messages on /rosout that are read."""
PATIENCE_S = 10.0
"""Time in seconds for reading them."""


class BagLog(msgspec.Struct, frozen=True):
    """The log of a bag.

    Args:
        events: at most `MAX_EVENTS` by time.
        warning: a sentence on what is missing of them, "" if nothing is.
    """

    events: Sequence[Event] = ()
    warning: str = ""


NOT_READ = BagLog()


class LogReader:
    """Reads the log of bags in a worker.

    Args:
        paths: of the bags.
        wake: called in the worker when `read` changes.
    """

    def __init__(self, paths: Sequence[Path], wake: Callable[[], object]) -> None:
        self._paths = paths
        self._wake = wake
        self._reading: Future[BagLog] | None = None

    def start(self, files: BagFiles) -> None:
        """Start once, if the bags have messages on /rosout, or may have.

        Raises:
            OSError: no thread is free.
        """
        if self._reading is None and files.is_used(ROSOUT) and _channels(files):
            self._reading = in_thread(lambda: read_log(self._paths))
            self._reading.add_done_callback(lambda _: self._wake())

    @property
    def read(self) -> BagLog:
        """The log; without events until it is read."""
        reading = self._reading
        return reading.result() if reading and _is_read(reading) else NOT_READ


def read_log(paths: Sequence[Path]) -> BagLog:
    """Read the warnings and errors of bags, from any thread, since it opens the files anew.

    Of too many, the most severe are kept, and a sample of those of the least level that is kept.

    Raises:
        BagError: a bag can no longer be read.
    """
    files = BagFiles(paths)
    try:
        return _read(files)
    finally:
        files.close()


def _read(files: BagFiles) -> BagLog:
    until_s = time.monotonic() + PATIENCE_S
    heap: list[tuple[int, float, int, Event]] = []
    chance = random.Random(0)  # the same sample each time
    count = size = 0
    warning = ""
    for recorded in files.messages(_channels(files), files.start_ns):
        size += len(recorded.cdr)
        if size > MAX_BYTES or time.monotonic() > until_s:
            at_s = (recorded.stamp_ns - files.start_ns) / 1e9
            warning = (
                f"The timeline shows warnings of {ROSOUT} only up to {at_s:.1f} s, since reading "
                "all takes too long. Split the bag to see the rest."
            )
            break
        is_short = len(recorded.cdr) <= LEVEL_AT
        if recorded.type == LOG and (is_short or recorded.cdr[LEVEL_AT] < WARN):
            continue
        if (record := event_of(recorded)) is None:
            continue
        level, event = record
        count += 1
        entry = (level, chance.random(), count, event)
        if len(heap) < MAX_EVENTS:
            heapq.heappush(heap, entry)
        else:
            heapq.heappushpop(heap, entry)
    events = tuple(event for *_, event in sorted(heap, key=lambda entry: entry[2]))
    return BagLog(events, warning)


def event_of(recorded: Recorded) -> tuple[int, Event] | None:
    """Return the level and the event of a message, None if it is neither a warning nor an error."""
    try:
        message = decode(recorded.type, recorded.cdr, recorded.types)
    except MessageError:
        return None
    level = message.level if recorded.type == LOG else ROS_1_LEVELS.get(message.level, 0)
    if level < WARN:
        return None
    name, text = shortened(message.name, MAX_NAME), _first_line(message.msg)
    shown_level = Level.ERROR if level >= ERROR else Level.WARN
    return level, Event(recorded.stamp_ns, shown_level, name, text)


def _channels(files: BagFiles) -> Sequence[BagChannel]:
    return [c for c in files.channels if c.topic == ROSOUT and c.type in (LOG, ROS_1_LOG)]


def _is_read(reading: Future[BagLog]) -> bool:
    return reading.done() and not reading.exception()


def _first_line(text: str) -> str:
    """Return the first line of a text that is not empty, shortened."""
    return shortened(text.lstrip().partition("\n")[0].rstrip(), MAX_TEXT)
