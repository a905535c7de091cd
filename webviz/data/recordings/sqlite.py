"""SQLite files of rosbag2 (.db3)."""

from __future__ import annotations

import contextlib
import sqlite3
import struct
import time
from collections import deque
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from webviz.data.recordings.recording import (
    END_MISSING,
    Counts,
    Losses,
    RecordedChannel,
    RecordedMessage,
    RecordingError,
    TextAllowance,
    TimeParts,
)
from webviz.data.recordings.unpacking import MAX_BYTES

MAX_TOPICS = 65_536
PATIENCE_S = 0.3
"""For finding out which topics have messages, when a file is opened."""
MAX_MISSES = 10_000
"""Consecutive rows that are missing or damaged, after which a damaged table counts as ended."""
IN_ONE_PAGE = 400
"""Larger messages may have parts beyond the end of a file that is cut off; SQLite reads zeros."""
MAX_ROW = 2**63 - 1
_TABLES = """\
SELECT count(*) FROM sqlite_master
WHERE type = 'table' AND rootpage > 0 AND name IN ('messages', 'topics')"""
_COLUMNS = "topic_id, timestamp, data FROM messages"


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
        self._db = _connected(path)
        try:
            self._is_cut = _is_cut(path)
            self._numbers = self._topics(path)
            self.span_ns = self._span()
        except sqlite3.Error as error:
            self._db.close()
            raise _damaged(path, str(error)) from error
        except BaseException:
            self._db.close()
            raise
        self.channels = tuple(dict.fromkeys(self._numbers.values()))
        self.losses.notes += [_unread(path, journal) for journal in _journals(path)]
        self.used = self._used()

    def messages(
        self, channels: Collection[RecordedChannel], start_ns: int, end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.messages`; of a damaged table in the order in which they were written."""
        wanted = {number: each for number, each in self._numbers.items() if each in channels}
        newest: list[RecordedMessage] = []
        """The delivered messages of one stamp."""
        rows = self._rows(wanted, start_ns, end_ns)
        while True:
            try:
                row = next(rows, None)
            except sqlite3.Error:
                break
            if row is None:
                return
            if entry := self._entry(wanted, *row):
                if newest and newest[0].stamp_ns != entry.stamp_ns:
                    newest.clear()
                newest.append(entry)
                yield entry
        start_ns = newest[0].stamp_ns if newest else start_ns
        for row in self._salvaged():
            entry = self._entry(wanted, *row)
            if entry and start_ns <= entry.stamp_ns <= end_ns and entry not in newest:
                yield entry

    def newest(
        self, channels: Collection[RecordedChannel], end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.newest`; of a damaged table at most `MAX_MISSES` messages."""
        wanted = {number: each for number, each in self._numbers.items() if each in channels}
        rows = self._rows(wanted, 0, end_ns, "DESC")
        while True:
            try:
                row = next(rows, None)
            except sqlite3.Error:
                break
            if row is None:
                return
            if entry := self._entry(wanted, *row):
                end_ns = min(end_ns, entry.stamp_ns - 1)
                yield entry
        yield from reversed(deque(self.messages(channels, 0, end_ns), MAX_MISSES))

    def histogram(self, parts: TimeParts) -> dict[RecordedChannel, Counts]:
        """`Recording.histogram`, of a damaged table without what it cannot read."""
        found = {channel: np.zeros(parts.count, np.int64) for channel in self.channels}
        with contextlib.closing(_connected(self._path)) as db, contextlib.suppress(sqlite3.Error):
            for number, part, count in db.execute(
                "SELECT topic_id, (timestamp - ?) / ? AS part, count(*) FROM messages "
                "WHERE typeof(timestamp) = 'integer' AND timestamp BETWEEN ? AND ? "
                "GROUP BY topic_id, part",
                (parts.start_ns, parts.length_ns, parts.start_ns, parts.end_ns),
            ):
                if number in self._numbers:
                    found[self._numbers[number]][part] += count
        return found

    def close(self) -> None:
        """Close the file."""
        self._db.close()

    def _used(self) -> frozenset[RecordedChannel]:
        """The channels that have messages, all if that takes long to find out."""
        until = time.monotonic() + PATIENCE_S
        self._db.set_progress_handler(lambda: time.monotonic() > until, 10_000)
        try:
            numbers = self._db.execute("SELECT DISTINCT topic_id FROM messages").fetchall()
        except sqlite3.Error:
            return frozenset(self.channels)
        finally:
            self._db.set_progress_handler(None, 0)
        return frozenset(self._numbers[n] for (n,) in numbers if n in self._numbers)

    def _topics(self, path: Path) -> dict[int, RecordedChannel]:
        """The channels by the ids of their topics."""
        if self._db.execute(_TABLES).fetchone() != (2,):
            if self._is_cut:
                raise _damaged(path, "its end is missing")
            raise RecordingError(
                f"{path} is a database of something else: give a bag of `ros2 bag record`."
            )
        allowance = TextAllowance()
        definitions = self._definitions(allowance)
        names = {row[1] for row in self._db.execute("PRAGMA table_info(topics)")}
        profiles = "offered_qos_profiles" if "offered_qos_profiles" in names else "''"
        found = {}
        for number, *texts in self._db.execute(
            f"SELECT id, name, type, serialization_format, {profiles} FROM topics "
            f"ORDER BY id LIMIT {MAX_TOPICS}"
        ):
            topic, type_name, encoding, qos = map(str, texts)
            if allowance.take(len(topic), len(type_name), len(encoding), len(qos)):
                definition = definitions.get(type_name, "")
                found[number] = RecordedChannel(topic, type_name, encoding, definition, qos)
        return found

    def _definitions(self, allowance: TextAllowance) -> dict[str, str]:
        """The .msg texts by type; older bags have none."""
        if not self._db.execute("PRAGMA table_info(message_definitions)").fetchall():
            return {}
        found = {}
        for name, encoding, text in self._db.execute(
            "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions "
            f"ORDER BY id LIMIT {MAX_TOPICS}"
        ):
            if encoding == "ros2msg" and allowance.take(len(str(name)), len(str(text))):
                found[str(name)] = str(text)
        return found

    def _span(self) -> tuple[int, int] | None:
        try:
            first, last = self._db.execute(
                "SELECT min(timestamp), max(timestamp) FROM messages"
            ).fetchone()
        except sqlite3.Error:
            stamps = [row[1] for row in self._salvaged() if isinstance(row[1], int)]
            return (min(stamps), max(stamps)) if stamps else None
        is_time = isinstance(first, int) and isinstance(last, int)
        return (first, last) if is_time else None

    def _rows(
        self, wanted: Collection[int], start_ns: int, end_ns: int, order: str = "ASC"
    ) -> Iterator[tuple[Any, Any, Any]]:
        marks = ", ".join("?" * len(wanted))
        rows = self._db.execute(
            f"SELECT {_COLUMNS} WHERE topic_id IN ({marks}) "
            f"AND timestamp BETWEEN ? AND ? ORDER BY timestamp {order}",
            (*wanted, start_ns, end_ns),
        )
        # Not from the cursor itself: it would be closed with the generator, perhaps after its file.
        yield from iter(rows.fetchone, None)

    def _salvaged(self) -> Iterator[tuple[Any, Any, Any]]:
        """The rows of a damaged table that can be read, one by one."""
        try:
            last = self._db.execute("SELECT max(id) FROM messages").fetchone()[0] or 0
        except sqlite3.Error:
            last = MAX_ROW
        number = misses = 0
        lost: list[int] = []
        while number < last and misses < MAX_MISSES:
            number += 1
            try:
                row = self._db.execute(f"SELECT {_COLUMNS} WHERE id = ?", (number,)).fetchone()
            except sqlite3.Error:
                row = None
                lost.append(number)
            if row is None:
                misses += 1
                continue
            misses = 0
            self._skip(lost)
            yield row
        if number == last:
            self._skip(lost)
        elif END_MISSING not in self.losses.others:
            self.losses.others.append(END_MISSING)

    def _skip(self, lost: list[int]) -> None:
        self.losses.skipped |= dict.fromkeys(lost, "the database is damaged")
        lost.clear()

    def _entry(
        self, wanted: dict[int, RecordedChannel], number: Any, stamp_ns: Any, data: Any
    ) -> RecordedMessage | None:
        if not (isinstance(stamp_ns, int) and isinstance(data, bytes) and number in wanted):
            return None
        if self._is_cut and len(data) > IN_ONE_PAGE and data.endswith(bytes(8)):
            self.losses.skipped[number, stamp_ns] = "it may be cut off"
            return None
        return RecordedMessage(wanted[number], stamp_ns, data)


def _connected(path: Path) -> sqlite3.Connection:
    """A connection for one thread at a time, which need not be the same all the time."""
    uri = f"{path.absolute().as_uri()}?immutable=1&mode=ro"
    db = sqlite3.connect(uri, uri=True, check_same_thread=False)
    try:
        db.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, MAX_BYTES)
        db.execute("PRAGMA trusted_schema = OFF")
        # Without it SQLite refuses a file that is shorter than its header says.
        db.execute("PRAGMA writable_schema = ON")
    except sqlite3.Error as error:
        db.close()
        raise _damaged(path, str(error)) from error
    return db


def _damaged(path: Path, reason: str) -> RecordingError:
    return RecordingError(
        f"{path} is damaged ({reason}): recover it with "
        f"`sqlite3 {path} .recover | sqlite3 recovered.db3`."
    )


def _journals(path: Path) -> list[str]:
    """Names of the files with changes that are not in the database yet."""
    names = [f"{path.name}{ending}" for ending in ("-wal", "-journal")]
    files = [path.with_name(name) for name in names]
    return [file.name for file in files if file.is_file() and file.stat().st_size]


def _unread(path: Path, journal: str) -> str:
    return (
        f"{path.name} has no end: it is still being recorded, or its recorder was interrupted. "
        f"What only {journal} contains is not shown; open it again when recording has ended."
    )


def _is_cut(path: Path) -> bool:
    """Return whether the file is smaller than its header says."""
    with path.open("rb") as file:
        page_size, pages = struct.unpack_from(">H10xI", file.read(32), 16)
    return path.stat().st_size < (page_size if page_size > 1 else 1 << 16) * pages
