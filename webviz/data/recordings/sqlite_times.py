"""The times at which topics of a db3 file have messages, found out by reading it once."""

from __future__ import annotations

import contextlib
import sqlite3
import threading
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

import numpy as np

from webviz.data.recordings.recording import Counts, RecordingError, TimeParts
from webviz.data.recordings.unpacking import MAX_BYTES

PARTS = 500
"""Of the span of the file: the next message of a topic is searched within one of them."""

_Span = tuple[int, int]
"""First and last time in ns, both included."""


class TopicTimes:
    """Spans of time in which topics have messages.

    Args:
        path: of the file.
        span_ns: of all of its messages.
    """

    def __init__(self, path: Path, span_ns: _Span) -> None:
        self._path = path
        self._parts = TimeParts(*span_ns, PARTS)
        self._reading = threading.Lock()
        self._spans: dict[int, list[_Span]] | None = None
        """By topic, in the order of time; None if the table was not read, or is damaged."""
        self.is_known = False
        """True once the whole table was read, or cannot be."""

    def count(self, parts: TimeParts) -> dict[int, Counts]:
        """Count the messages of each topic by reading the whole table, from any thread.

        Raises:
            sqlite3.Error: the table is damaged.
        """
        with self._reading:
            try:
                return self._read(parts)
            finally:
                self.is_known = True

    def spans(
        self, topics: Collection[int], start_ns: int, end_ns: int, is_backwards: bool
    ) -> Iterator[_Span]:
        """Spans that contain all messages of some topics between two times, by time or against it.

        The first call reads the whole table, unless `count` has.
        """
        with self._reading:
            is_known = self.is_known
        if not is_known:
            with contextlib.suppress(sqlite3.Error):
                self.count(self._parts)
        spans = [(start_ns, end_ns)]
        if self._spans is not None:
            spans = _joined(span for topic in topics for span in self._spans.get(topic, ()))
        for first_ns, last_ns in reversed(spans) if is_backwards else spans:
            if first_ns <= end_ns and start_ns <= last_ns:
                yield max(first_ns, start_ns), min(last_ns, end_ns)

    def _read(self, parts: TimeParts) -> dict[int, Counts]:
        spans: dict[int, list[_Span]] = {}
        counts: dict[int, Counts] = {}
        with contextlib.closing(connected(self._path)) as db:
            for topic, part, _, count, first_ns, last_ns in db.execute(
                "SELECT topic_id, (timestamp - ?) / ? AS part, (timestamp - ?) / ? AS own, "
                "count(*), min(timestamp), max(timestamp) FROM messages "
                "WHERE typeof(timestamp) = 'integer' AND timestamp BETWEEN ? AND ? "
                "GROUP BY topic_id, part, own ORDER BY topic_id, part, own",
                (
                    *(parts.start_ns, parts.length_ns),
                    *(self._parts.start_ns, self._parts.length_ns),
                    *(parts.start_ns, parts.end_ns),
                ),
            ):
                if topic not in counts:
                    counts[topic] = np.zeros(parts.count, np.int64)
                    spans[topic] = [(first_ns, last_ns)]
                counts[topic][part] += count
                began_ns, ended_ns = spans[topic][-1]
                if first_ns - ended_ns <= self._parts.length_ns:
                    spans[topic][-1] = began_ns, last_ns
                else:
                    spans[topic].append((first_ns, last_ns))
        self._spans = spans
        return counts


def _joined(spans: Iterable[_Span]) -> list[_Span]:
    """Unite spans that overlap, in the order of time."""
    found: list[_Span] = []
    for first_ns, last_ns in sorted(spans):
        if found and first_ns <= found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], last_ns)
        else:
            found.append((first_ns, last_ns))
    return found


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
    return RecordingError(
        f"{path} is damaged ({reason}): recover it with "
        f"`sqlite3 {path} .recover | sqlite3 recovered.db3`."
    )
