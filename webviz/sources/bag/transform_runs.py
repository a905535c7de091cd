"""When the frames of a bag have transforms, read ahead of playing."""

from __future__ import annotations

import concurrent.futures
import itertools
import threading
from collections.abc import Sequence
from concurrent.futures import Future
from pathlib import Path

from webviz.data.disk import DiskThreads
from webviz.data.recordings.latched import TF
from webviz.sources.bag.files import BagFiles
from webviz.sources.history import Runs

MAX_MESSAGES = 1_000_000
"""Of which the frames are looked at: nine hours at 30 a second."""
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
