"""The times at which topics of a db3 file have messages, found out by reading it once."""

from __future__ import annotations

import contextlib
import itertools
import math
import sqlite3
import textwrap
import threading
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from webviz.data.disk import DiskThreads
from webviz.data.recordings.recording import Counts, RecordingError, TimeParts
from webviz.data.recordings.set_back import LEAST_NS, SetBack
from webviz.data.recordings.unpacking import MAX_BYTES

MAX_REASON = 200
"""Characters of what SQLite says about a file."""
PARTS = 500
"""Number of parts of the span of the file: the next message of a topic is searched within one of
them."""
SLICES = 100
"""Number of slices of the table, in the order of writing: what is found in each is known at
once."""

_Span = tuple[int, int]
"""First and last time in ns, both included."""

_readers = DiskThreads(16)
"""Threads for whole tables, which take longer than other files."""


class TopicTimes:
    """Spans of time in which topics have messages.

    Args:
        path: of the file.
        span_ns: of all of its messages.
        totals: numbers of messages of topics as the recorder noted them. Once that many of a topic
            are found, the rest of the table is not waited for; empty if unknown.
    """

    def __init__(self, path: Path, span_ns: _Span, totals: Mapping[int, int]) -> None:
        self._path = path
        self._parts = TimeParts(*span_ns, PARTS)
        self._totals = totals
        self._reading = threading.Lock()
        self._progress = threading.Condition()
        """Held while the following are changed."""
        self._spans: dict[int, list[_Span]] = {}
        self._row_counts = Counter[int]()
        self._is_read = self._is_damaged = self._is_closed = False
        self.set_back: SetBack | None = None
        """A jump of the clock, once the table is read: not one that is shorter than a slice."""

    def count(self, parts: TimeParts) -> dict[int, Counts]:
        """Count the messages of each topic by reading the whole table, from any thread.

        Raises:
            sqlite3.Error: the table is damaged.
        """
        with self._reading:
            try:
                return self._read(parts)
            except BaseException:
                self._is_damaged = True
                raise
            finally:
                with self._progress:
                    self._is_read = True
                    self._progress.notify_all()

    def knows(self, topics: Collection[int]) -> bool:
        """Return whether all messages of some topics are found, or cannot be."""
        return self._is_read or all(
            self._row_counts[topic] >= self._totals.get(topic, math.inf) for topic in topics
        )

    def spans(
        self, topics: Collection[int], start_ns: int, end_ns: int, is_backwards: bool
    ) -> Iterator[_Span]:
        """Spans that contain all messages of some topics between two times, by time or against it.

        Waits until a worker has found them.
        """
        with self._progress:
            if not self.knows(topics) and not self._reading.locked():
                self._start_reading()
            self._progress.wait_for(lambda: self.knows(topics))
            spans = _joined(span for topic in topics for span in self._spans.get(topic, ()))
        if self._is_damaged:
            spans = [(start_ns, end_ns)]
        for first_ns, last_ns in reversed(spans) if is_backwards else spans:
            if first_ns <= end_ns and start_ns <= last_ns:
                yield max(first_ns, start_ns), min(last_ns, end_ns)

    def close(self) -> None:
        """Let a worker end early."""
        self._is_closed = True

    def _start_reading(self) -> None:
        try:
            _readers.start(lambda: self.count(self._parts))
        except OSError:  # no thread is free
            with contextlib.suppress(sqlite3.Error):
                self.count(self._parts)

    def _read(self, parts: TimeParts) -> dict[int, Counts]:
        counts: dict[int, Counts] = {}
        newest: dict[int, int] = {}
        with contextlib.closing(connected(self._path)) as db:
            for after, until in slices(db):
                if self._is_closed:
                    break
                rows = db.execute(
                    "SELECT topic_id, (timestamp - ?) / ? AS part, (timestamp - ?) / ? AS own, "
                    "count(*), min(timestamp), max(timestamp) FROM messages "
                    "WHERE typeof(timestamp) = 'integer' AND timestamp BETWEEN ? AND ? "
                    "AND id > ? AND id <= ? "
                    "GROUP BY topic_id, part, own ORDER BY topic_id, part, own",
                    (
                        *(parts.start_ns, parts.length_ns),
                        *(self._parts.start_ns, self._parts.length_ns),
                        *(parts.start_ns, parts.end_ns),
                        *(after, until),
                    ),
                ).fetchall()
                self._compare(rows, newest)
                with self._progress:
                    for topic, part, _, count, first_ns, last_ns in rows:
                        if topic not in counts:
                            counts[topic] = np.zeros(parts.count, np.int64)
                        counts[topic][part] += count
                        self._note(topic, count, first_ns, last_ns)
                    self._progress.notify_all()
        return counts

    def _compare(self, rows: Sequence[Sequence[int]], newest: dict[int, int]) -> None:
        """Look for a jump back of time from the slices before, whose newest times are given."""
        for topic, *_, first_ns, _ in rows:
            before_ns = newest.get(topic, first_ns)
            if before_ns - first_ns > LEAST_NS:
                jump = SetBack(first_ns, before_ns)
                if self.set_back is None or jump.after_ns < self.set_back.after_ns:
                    self.set_back = jump
        for topic, *_, last_ns in rows:
            newest[topic] = max(newest.get(topic, last_ns), last_ns)

    def _note(self, topic: int, count: int, first_ns: int, last_ns: int) -> None:
        """Add messages, unless the table was read before."""
        if self._is_read:
            return
        self._row_counts[topic] += count
        spans = self._spans.setdefault(topic, [])
        reach_ns = self._parts.length_ns
        if spans and spans[-1][0] - reach_ns <= last_ns and first_ns <= spans[-1][1] + reach_ns:
            spans[-1] = min(spans[-1][0], first_ns), max(spans[-1][1], last_ns)
        else:
            spans.append((first_ns, last_ns))


def slices(db: sqlite3.Connection) -> Sequence[_Span]:
    """Ids of messages: those after the first and up to the second of each pair."""
    first, last = db.execute("SELECT min(id), max(id) FROM messages").fetchone()
    if first is None:
        return ()
    if not isinstance(first, int) or not isinstance(last, int):
        raise sqlite3.DataError("the messages are not numbered")
    ends = [first - 1 + (last + 1 - first) * number // SLICES for number in range(SLICES + 1)]
    return list(itertools.pairwise(ends))


def _joined(spans: Iterable[_Span]) -> list[_Span]:
    """Unite spans that overlap, in the order of time."""
    joined_spans: list[_Span] = []
    for first_ns, last_ns in sorted(spans):
        if joined_spans and first_ns <= joined_spans[-1][1]:
            joined_spans[-1] = joined_spans[-1][0], max(joined_spans[-1][1], last_ns)
        else:
            joined_spans.append((first_ns, last_ns))
    return joined_spans


def connected(path: Path) -> sqlite3.Connection:
    """Connect to a database for one thread at a time, which need not be the same all the time.

    It is read as it is: without its journals, and without anything that its schema would compute
    except generated columns, whose values are bounded as all are.

    Raises:
        RecordingError: it is damaged.
    """
    uri = f"{path.absolute().as_uri()}?immutable=1&mode=ro"
    db = sqlite3.connect(uri, uri=True, check_same_thread=False)
    try:
        db.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, MAX_BYTES)
        db.execute("PRAGMA trusted_schema = OFF")
        # Without it SQLite refuses a file that is shorter than its header says.
        db.execute("PRAGMA writable_schema = ON")
    except sqlite3.Error as error:
        db.close()
        raise damaged(path, str(error)) from error
    return db


def damaged(path: Path, reason: str) -> RecordingError:
    """Return the error for a database that cannot be read, with the remedy."""
    line = " ".join(reason.split())  # SQLite may cite a name or text of the file
    return RecordingError(
        f"{path} is damaged ({textwrap.shorten(line, MAX_REASON)}): recover it with "
        f"`sqlite3 {path} .recover | sqlite3 recovered.db3`."
    )
