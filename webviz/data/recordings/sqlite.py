"""SQLite files of rosbag2 (.db3)."""

from __future__ import annotations

import contextlib
import math
import sqlite3
import time
from collections import Counter, deque
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
from msgspec.structs import replace

from webviz.data.recordings.metadata import recorded_counts
from webviz.data.recordings.recording import (
    DEFINITION_ENCODINGS,
    END_MISSING,
    Counts,
    Losses,
    RecordedChannel,
    RecordedMessage,
    RecordingError,
    TextAllowance,
    TimeParts,
)
from webviz.data.recordings.sqlite_files import is_cut, journals, unread
from webviz.data.recordings.sqlite_times import TopicTimes, connected, damaged
from webviz.data.recordings.unpacking import unpack_message

MAX_TOPICS = 65_536
PATIENCE_S = 0.1
"""Time in seconds for finding the next message of some topics, or all topics that have messages."""
PROGRESS = 10_000
"""Instructions of SQLite between two looks at the clock."""
BATCHES = (1, 16, 256, 4096, -1)
"""Numbers of rows of consecutive queries; -1 for no limit."""
MAX_MISSES = 10_000
"""Consecutive rows that are missing or damaged, after which a damaged table counts as ended."""
IN_ONE_PAGE = 400
"""Larger messages may have parts beyond the end of a file that is cut off; SQLite reads zeros."""
MAX_ROW = 2**63 - 1
_TABLES = """\
SELECT count(*) FROM sqlite_master
WHERE type = 'table' AND rootpage > 0 AND name IN ('messages', 'topics')"""
_COLUMNS = "id, topic_id, timestamp, data FROM messages"
_STAMPS = "id, topic_id, timestamp, x'' FROM messages"
"""Columns and table without the data."""


class _Row(NamedTuple):
    """A message as it is in the table, which may hold values of any type."""

    id: Any
    topic_id: Any
    stamp_ns: Any
    data: Any


class Query(msgspec.Struct, frozen=True):
    """Messages to read.

    Args:
        topics: their ids.
        start_ns, end_ns: times of recording, both included.
        is_backwards: newest first.
        last: stamp and id of a message up to which all are known.
        columns: of each row.
    """

    topics: Collection[int]
    start_ns: int
    end_ns: int
    is_backwards: bool
    last: tuple[int, int] = (-1, 0)
    columns: str = _COLUMNS

    def after(self, row: _Row) -> Query:
        """Return the rest behind a row."""
        stamp_ns = row.stamp_ns
        if self.is_backwards:
            return replace(self, end_ns=stamp_ns, last=(stamp_ns, row.id))
        return replace(self, start_ns=stamp_ns, last=(stamp_ns, row.id))

    def within(self, start_ns: int, end_ns: int) -> Query:
        """Return the part within a span."""
        return replace(self, start_ns=start_ns, end_ns=end_ns)

    def sql(self, limit: int) -> tuple[str, Sequence[int]]:
        """Return the statement and its values; a limit of -1 is none."""
        marks = ", ".join("?" * len(self.topics))
        order, comparison = ("DESC", ">=") if self.is_backwards else ("ASC", "<=")
        return (
            f"SELECT {self.columns} WHERE topic_id IN ({marks}) AND timestamp BETWEEN ? AND ? "
            f"AND NOT (timestamp = ? AND id {comparison} ?) "
            f"ORDER BY timestamp {order}, id {order} LIMIT ?",
            (*self.topics, self.start_ns, self.end_ns, *self.last, limit),
        )


class _TakesLong(Exception):
    """A row was not found within the given time."""


class SqliteRecording:
    """The messages of a db3 file.

    The database is read as it is: without its journals, and without anything that its schema would
    compute except generated columns, whose values are bounded as all are.

    Args:
        path: of the file.

    Raises:
        RecordingError: it is another or a damaged database.
    """

    def __init__(self, path: Path) -> None:
        self.losses = Losses("message", "skipped")
        self._path = path
        self._db = connected(path)
        try:
            self._is_cut = is_cut(path)
            self._numbers = self._topics(path)
            self.span_ns = self._span()
        except sqlite3.Error as error:
            self._db.close()
            raise damaged(path, str(error)) from error
        except BaseException:
            self._db.close()
            raise
        self.channels = tuple(dict.fromkeys(self._numbers.values()))
        self.losses.notes += [unread(path, journal) for journal in journals(path)]
        self.used = self._used()
        self._times = TopicTimes(path, self.span_ns or (0, 0), self._totals(path))

    def messages(
        self, channels: Collection[RecordedChannel], start_ns: int, end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.messages`; of a damaged table in the order in which they were written."""
        chosen = {number: each for number, each in self._numbers.items() if each in channels}
        newest: list[RecordedMessage] = []
        """The delivered messages of one stamp."""
        rows = self._rows(chosen, start_ns, end_ns)
        while True:
            try:
                row = next(rows, None)
            except sqlite3.Error:
                break
            if row is None:
                return
            if entry := self._entry(chosen, row):
                if newest and newest[0].stamp_ns != entry.stamp_ns:
                    newest.clear()
                newest.append(entry)
                yield entry
        start_ns = newest[0].stamp_ns if newest else start_ns
        for row in self._salvaged():
            entry = self._entry(chosen, row)
            if entry and start_ns <= entry.stamp_ns <= end_ns and entry not in newest:
                yield entry

    def newest(
        self, channels: Collection[RecordedChannel], end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.newest`; of a damaged table at most `MAX_MISSES` messages."""
        chosen = {number: each for number, each in self._numbers.items() if each in channels}
        rows = self._rows(chosen, 0, end_ns, is_backwards=True)
        while True:
            try:
                row = next(rows, None)
            except sqlite3.Error:
                break
            if row is None:
                return
            if entry := self._entry(chosen, row):
                end_ns = min(end_ns, entry.stamp_ns - 1)
                yield entry
        yield from reversed(deque(self.messages(channels, 0, end_ns), MAX_MISSES))

    def newest_stamps(self, channels: Collection[RecordedChannel], end_ns: int) -> Iterator[int]:
        """`Recording.newest_stamps`; of a damaged table as far as it can be read."""
        chosen = {number for number, each in self._numbers.items() if each in channels}
        with contextlib.suppress(sqlite3.Error):
            for row in self._rows(chosen, 0, end_ns, is_backwards=True, columns=_STAMPS):
                if isinstance(row.stamp_ns, int):
                    yield row.stamp_ns

    def histogram(self, parts: TimeParts) -> dict[RecordedChannel, Counts]:
        """`Recording.histogram`, of a damaged table without what it cannot read."""
        histogram = {channel: np.zeros(parts.count, np.int64) for channel in self.channels}
        with contextlib.suppress(sqlite3.Error):
            for number, counts in self._times.count(parts).items():
                if number in self._numbers:
                    histogram[self._numbers[number]] += counts
            if set_back := self._times.set_back:
                note = set_back.note(self._path.name, parts.start_ns)
                self.losses.notes = list(dict.fromkeys([*self.losses.notes, note]))
        return histogram

    def close(self) -> None:
        """Close the file."""
        self._times.close()
        self._db.close()

    def _used(self) -> frozenset[RecordedChannel]:
        """Return the channels that have messages, all if that takes long to find out."""
        try:
            with self._hurrying(PATIENCE_S):
                numbers = self._db.execute("SELECT DISTINCT topic_id FROM messages").fetchall()
        except (sqlite3.Error, _TakesLong):
            return frozenset(self.channels)
        return frozenset(self._numbers[n] for (n,) in numbers if n in self._numbers)

    def _topics(self, path: Path) -> dict[int, RecordedChannel]:
        """Return the channels by the ids of their topics."""
        if self._db.execute(_TABLES).fetchone() != (2,):
            if self._is_cut:
                raise damaged(path, "its end is missing")
            raise RecordingError(f"{path} is not a bag: choose one written by `ros2 bag record`.")
        # Of messages, invalid text is damage; of topics, such as in their QoS, the rest is good.
        self._db.text_factory = lambda text: text.decode(errors="replace")
        allowance = TextAllowance()
        definitions = self._definitions(allowance)
        names = {row[1] for row in self._db.execute("PRAGMA table_info(topics)")}
        profiles = "offered_qos_profiles" if "offered_qos_profiles" in names else "''"
        topics = {}
        for number, *texts in self._db.execute(
            f"SELECT id, name, type, serialization_format, {profiles} FROM topics "
            f"ORDER BY id LIMIT {MAX_TOPICS}"
        ):
            topic, type_name, encoding, qos = map(str, texts)
            if allowance.take(len(topic), len(type_name), len(encoding), len(qos)):
                definition = definitions.get(type_name, "")
                topics[number] = RecordedChannel(topic, type_name, encoding, definition, qos)
        self._db.text_factory = str
        return topics

    def _definitions(self, allowance: TextAllowance) -> dict[str, str]:
        """Return the definitions by type; older bags have none."""
        if not self._db.execute("PRAGMA table_info(message_definitions)").fetchall():
            return {}
        texts = {}
        for name, encoding, text in self._db.execute(
            "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions "
            f"ORDER BY id LIMIT {MAX_TOPICS}"
        ):
            if encoding in DEFINITION_ENCODINGS and allowance.take(len(str(name)), len(str(text))):
                texts[str(name)] = str(text)
        return texts

    def _totals(self, path: Path) -> Mapping[int, int]:
        """Return the numbers of messages by topic, if metadata.yaml is of this file alone."""
        try:
            (last,) = self._db.execute("SELECT max(id) FROM messages").fetchone()
        except sqlite3.Error:
            return {}
        counts = recorded_counts(path)
        if sum(counts.values()) != last:
            return {}
        topics = Counter(channel.topic for channel in self._numbers.values())
        numbers = {n: c.topic for n, c in self._numbers.items() if topics[c.topic] == 1}
        return {number: counts.get(topic, 0) for number, topic in numbers.items()}

    def _span(self) -> tuple[int, int] | None:
        try:
            first, last = self._db.execute(
                "SELECT (SELECT min(timestamp) FROM messages), "
                "(SELECT max(timestamp) FROM messages)"
            ).fetchone()
        except sqlite3.Error:
            rows = self._salvaged()
            stamps = [row.stamp_ns for row in rows if isinstance(row.stamp_ns, int)]
            return (min(stamps), max(stamps)) if stamps else None
        is_time = isinstance(first, int) and isinstance(last, int)
        return (first, last) if is_time else None

    def _rows(
        self,
        topics: Collection[int],
        start_ns: int,
        end_ns: int,
        is_backwards: bool = False,
        columns: str = _COLUMNS,
    ) -> Iterator[_Row]:
        """Yield the rows of some topics within a span, by time or against it.

        The only index of rosbag2 is one of times. Finding the next message of a rare topic by it
        takes reading everything in between, so that of such topics it is found out first when
        they have messages.

        Raises:
            sqlite3.Error: the table is damaged.
        """
        if not topics:
            return
        query = Query(topics, start_ns, end_ns, is_backwards, columns=columns)
        if not self._times.knows(topics):
            row = None
            try:
                for row in self._queried(query, PATIENCE_S):
                    yield row
                return
            except _TakesLong:
                query = query.after(row) if row else query
        for span in self._times.spans(topics, query.start_ns, query.end_ns, is_backwards):
            yield from self._queried(query.within(*span))

    def _queried(self, query: Query, patience_s: float = math.inf) -> Iterator[_Row]:
        """Yield the rows that answer a query.

        They are taken few by few at first: sqlite3 looks for the next row before it returns one,
        and may read the whole table for the second of a rare topic.

        Raises:
            _TakesLong: the next row is not found in time.
            sqlite3.Error: the table is damaged.
        """
        for limit in BATCHES:
            count, row = 0, None
            with self._hurrying(patience_s):
                rows = self._db.execute(*query.sql(limit))
            while True:
                with self._hurrying(patience_s):
                    values = rows.fetchone()
                if values is None:
                    break
                row = _Row(*values)
                count += 1
                yield row
            if row is None or count != limit:
                return
            query = query.after(row)

    @contextlib.contextmanager
    def _hurrying(self, patience_s: float) -> Iterator[None]:
        """End what the database does after a time.

        Raises:
            _TakesLong: it was ended.
        """
        if math.isinf(patience_s):
            yield
            return
        until = time.monotonic() + patience_s
        self._db.set_progress_handler(lambda: time.monotonic() > until, PROGRESS)
        try:
            yield
        except sqlite3.OperationalError as error:
            # Errors of the module itself, such as of invalid text, have no code.
            if getattr(error, "sqlite_errorcode", 0) != sqlite3.SQLITE_INTERRUPT:
                raise
            raise _TakesLong from None
        finally:
            self._db.set_progress_handler(None, 0)

    def _salvaged(self) -> Iterator[_Row]:
        """Yield the rows of a damaged table that can be read, one by one."""
        try:
            last = self._db.execute("SELECT max(id) FROM messages").fetchone()[0] or 0
        except sqlite3.Error:
            last = MAX_ROW
        number = misses = 0
        unreadable: list[int] = []
        while number < last and misses < MAX_MISSES:
            number += 1
            try:
                row = self._db.execute(f"SELECT {_COLUMNS} WHERE id = ?", (number,)).fetchone()
            except sqlite3.Error:
                row = None
                unreadable.append(number)
            misses = misses + 1 if row is None else 0
            if row is not None:
                self._skip(unreadable)
                yield _Row(*row)
        if number == last:
            self._skip(unreadable)
        elif END_MISSING not in self.losses.others:
            self.losses.others.append(END_MISSING)

    def _skip(self, rows: list[int]) -> None:
        self.losses.skipped |= dict.fromkeys(rows, "the database is damaged")
        rows.clear()

    def _entry(self, channels: dict[int, RecordedChannel], row: _Row) -> RecordedMessage | None:
        _, number, stamp_ns, data = row
        if not (isinstance(stamp_ns, int) and isinstance(data, bytes) and number in channels):
            return None
        message, fault = unpack_message(data, channels[number].encoding)
        if self._is_cut and len(data) > IN_ONE_PAGE and data.endswith(bytes(8)):
            fault = "it may be cut off"
        if fault:
            self.losses.skipped[number, stamp_ns] = fault
            return None
        return RecordedMessage(channels[number], stamp_ns, message)
