"""When the frames of a bag have transforms: those that ended are needed long after."""

from __future__ import annotations

import bisect
import concurrent.futures
import itertools
import threading
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path

from webviz.data.disk import DiskThreads
from webviz.data.messages import MessageError, TFMessage, decode
from webviz.sources.bag.files import BagFiles
from webviz.sources.bag.time import TF

GAP_NS = 1_000_000_000
"""Without a transform, after which those of a frame count as ended."""
MAX_MESSAGES = 1_000_000
"""Of which the frames are looked at: nine hours at 30 a second."""
MAX_ENDS = 200
"""Newest ends that a seek reads."""
WAIT_S = 1.0
"""For the first seek; a bag of ten minutes takes some tenths."""
MAX_STATIC = 10_000
"""Messages of static transforms."""
AT_ONCE = 50_000
"""Messages that are read without a pause."""
YIELD_AFTER, YIELD_S = 500, 0.02
"""Of a longer bag: messages between two pauses, so that the frame loop has the interpreter."""

_readers = DiskThreads(16)
"""For whole bags, which take longer than other files."""


def links_in(cdr: bytes) -> Iterator[tuple[str, str]]:
    """Yield parents and children of the transforms of a message; none if it cannot be decoded."""
    try:
        message: TFMessage = decode(TF, cdr)
    except MessageError:
        return
    for each in message.transforms:
        yield each.parent.removeprefix("/"), each.child.removeprefix("/")


class Runs:
    """The spans of time in which each frame has transforms."""

    def __init__(self) -> None:
        self._begins: dict[str, list[int]] = {}
        self._ends: dict[str, list[int]] = {}
        self._parents: dict[str, str] = {}
        """The last ones, of static transforms, too."""

    def add(self, parent: str, child: str, stamp_ns: int) -> None:
        """Note a transform; stamps must not decrease."""
        self._parents[child] = parent
        ends = self._ends.setdefault(child, [])
        begins = self._begins.setdefault(child, [])
        if ends and stamp_ns - ends[-1] <= GAP_NS:
            ends[-1] = stamp_ns
        else:
            begins.append(stamp_ns)
            ends.append(stamp_ns)

    def read(self, cdr: bytes, stamp_ns: int, is_static: bool = False) -> None:
        """Note the transforms of a message; stamps must not decrease."""
        for parent, child in links_in(cdr):
            if is_static:
                self._parents[child] = parent
            else:
                self.add(parent, child, stamp_ns)

    def above(self, frame: str, at_ns: int) -> Mapping[str, int | None]:
        """Return the moving frames from one up to its root, and when their last transforms were.

        Args:
            frame: frame id.
            at_ns: of the transforms until then; None stands for less than `GAP_NS` before.
        """
        found: dict[str, int | None] = {}
        seen = set[str]()
        while frame in self._parents and frame not in seen:
            seen.add(frame)
            number = bisect.bisect_right(self._begins.get(frame, ()), at_ns) - 1
            if number >= 0:
                end_ns = self._ends[frame][number]
                found[frame] = end_ns if end_ns < at_ns else None
            frame = self._parents[frame]
        return found

    def ended_ns(self, before_ns: int) -> Sequence[int]:
        """Return when all frames without a transform at a time had their last, in order."""
        found = set[int]()
        for child, begins in self._begins.items():
            number = bisect.bisect_right(begins, before_ns) - 1
            if number >= 0 and (end_ns := self._ends[child][number]) < before_ns:
                found.add(end_ns)
        return sorted(found)[-MAX_ENDS:]


class TransformRuns:
    """Finds the runs in a worker, once they are asked for.

    Args:
        paths: of the bags, which it opens anew.
    """

    def __init__(self, paths: Sequence[Path]) -> None:
        self._paths = paths
        self._reading: Future[Runs] | None = None
        self._is_closed = threading.Event()

    def found(self) -> Runs:
        """Return the runs; none until they are found, for which the first call waits a little."""
        wait_s = 0.0
        if self._reading is None:
            try:
                self._reading = _readers.start(self._read)
            except OSError:  # no thread is free; another time
                return Runs()
            wait_s = WAIT_S
        concurrent.futures.wait([self._reading], wait_s)
        # That a bag can no longer be read, others report.
        is_read = self._reading.done() and not self._reading.exception()
        return self._reading.result() if is_read else Runs()

    def close(self) -> None:
        """Stop reading."""
        self._is_closed.set()

    def _read(self) -> Runs:
        runs = Runs()
        bags = BagFiles(self._paths)
        static = [c for c in bags.channels if c.type == TF and c.topic.endswith("/tf_static")]
        moving = [c for c in bags.channels if c.type == TF and c not in static]
        try:
            for recorded in itertools.islice(bags.messages(static, bags.start_ns), MAX_STATIC):
                runs.read(recorded.cdr, recorded.stamp_ns, is_static=True)
            for number, recorded in enumerate(bags.messages(moving, bags.start_ns), 1):
                if number > MAX_MESSAGES or self._is_closed.is_set():
                    break
                runs.read(recorded.cdr, recorded.stamp_ns)
                if number > AT_ONCE and number % YIELD_AFTER == 0:
                    self._is_closed.wait(YIELD_S)
        finally:
            bags.close()
        return runs
