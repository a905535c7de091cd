"""Rare topics of db3 files, whose index has times only."""

from __future__ import annotations

import functools
import random
import sqlite3
import threading
from collections.abc import Iterable, Iterator
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from bags import START_NS, Bag, files, ns, strings
from rosbags.rosbag2 import StoragePlugin

from webviz.data.recordings import open_recording, sqlite, sqlite_times
from webviz.data.recordings.recording import RecordedMessage
from webviz.data.recordings.sqlite import SqliteRecording

TOPICS = ("/often", "/bursts", "/rare")
DURATION_S = 50


def write_bag(path: Path, seed: int) -> Path:
    """A db3 file whose topics have messages now and then, some at the same time."""
    chance = random.Random(seed)
    bag = Bag()
    for topic in (*TOPICS, "/never"):
        bag.add(topic, "std_msgs/msg/String")
    for tenths in range(10 * DURATION_S):
        at_s = tenths // 3 * 0.3
        bag.put(at_s, "/often", {"data": f"{tenths}"})
        if tenths // 50 % 4 == 1:
            bag.put(at_s, "/bursts", {"data": f"{tenths} again"})
    for _ in range(3):
        bag.put(chance.randrange(DURATION_S), "/rare", {"data": f"{chance.random()}"})
    (file,) = files(bag.write(path, StoragePlugin.SQLITE3), ".db3")
    return file


def hasten(monkeypatch: pytest.MonkeyPatch, chance: random.Random, share: float) -> None:
    """Let some queries take long, by chance."""

    def monotonic() -> float:
        return 1e9 if chance.random() < share else 0.0

    monkeypatch.setattr(sqlite, "time", SimpleNamespace(monotonic=monotonic))
    monkeypatch.setattr(sqlite, "PROGRESS", 1)
    monkeypatch.setattr(sqlite, "PATIENCE_S", 1.0)


@pytest.mark.parametrize("share", [0.0, 0.002, 0.05, 1.0])
@pytest.mark.parametrize("seed", range(4))
def test_all_messages_come_in_order_at_any_speed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, seed: int, share: float
) -> None:
    path = write_bag(tmp_path / "run", seed)
    with closing(sqlite3.connect(path)) as db:
        rows = db.execute(
            "SELECT name, timestamp, data FROM messages JOIN topics ON topics.id = topic_id "
            "ORDER BY timestamp, messages.id"
        ).fetchall()
    chance = random.Random(seed)
    hasten(monkeypatch, chance, share)
    monkeypatch.setattr(sqlite, "recorded_counts", functools.cache(sqlite.recorded_counts))

    def plain(messages: Iterable[RecordedMessage]) -> list[tuple[str, int, bytes]]:
        return [(each.channel.topic, each.stamp_ns, each.data) for each in messages]

    for _ in range(20):
        recording = SqliteRecording(path)
        first_ns, last_ns = sorted(START_NS + ns(chance.uniform(-5, 55)) for _ in range(2))
        expected = set(chance.sample(TOPICS, chance.randrange(4)))
        channels = [channel for channel in recording.channels if channel.topic in expected]
        truth = [row for row in rows if row[0] in expected and row[1] <= last_ns]
        assert plain(recording.newest(channels, last_ns)) == truth[::-1]
        between = [row for row in truth if row[1] >= first_ns]
        assert plain(recording.messages(channels, first_ns, last_ns)) == between
        recording.close()


def test_the_first_message_of_a_rare_topic_is_found_without_looking_for_the_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bag = strings(*(number / 100 for number in range(3000)))
    bag.add("/map", "std_msgs/msg/String")
    bag.put(0, "/map", {"data": "map"})
    (file,) = files(bag.write(tmp_path / "run", StoragePlugin.SQLITE3), ".db3")
    recording = SqliteRecording(file)
    looks: list[None] = []
    clock = SimpleNamespace(monotonic=lambda: looks.append(None) or 0.0)
    monkeypatch.setattr(sqlite, "time", clock)
    monkeypatch.setattr(sqlite, "PROGRESS", 100)
    channels = [channel for channel in recording.channels if channel.topic == "/map"]
    result = recording.messages(channels, START_NS, START_NS + ns(30))
    assert next(result).stamp_ns == START_NS
    assert len(looks) < 20  # of 100 instructions each; there are 3000 other messages
    recording.close()


def test_a_range_read_by_the_histogram_is_not_searched_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recording = open_recording(write_bag(tmp_path / "run", 1))
    assert recording.span_ns is not None
    recording.histogram(sqlite.TimeParts(*recording.span_ns, 10))
    spans: list[tuple[int, int]] = []
    sql = sqlite.Query.sql

    def noted(query: sqlite.Query, limit: int) -> Any:
        spans.append((query.start_ns, query.end_ns))
        return sql(query, limit)

    monkeypatch.setattr(sqlite.Query, "sql", noted)
    channels = [channel for channel in recording.channels if channel.topic == "/bursts"]
    assert len(list(recording.messages(channels, *recording.span_ns))) == 150
    assert sum(end - start for start, end in spans) < 3 * ns(15)  # in three bursts of 5 s
    channels = [channel for channel in recording.channels if channel.topic == "/never"]
    spans.clear()
    assert list(recording.newest(channels, recording.span_ns[1])) == []
    assert spans == []
    recording.close()


def test_a_topic_with_all_messages_counted_does_not_wait_for_the_rest_of_the_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bag = strings(*range(100))
    bag.add("/map", "std_msgs/msg/String")
    bag.put(1.5, "/map", {"data": "map"})
    (file,) = files(bag.write(tmp_path / "run", StoragePlugin.SQLITE3), ".db3")
    slices, is_over = sqlite_times.slices, threading.Event()

    def slow(db: sqlite3.Connection) -> Iterator[tuple[int, int]]:
        first, *others = slices(db)
        yield first[0], first[1] + 10
        is_over.wait(60.0)
        yield from others

    monkeypatch.setattr(sqlite_times, "slices", slow)
    hasten(monkeypatch, random.Random(1), share=1.0)
    recording = SqliteRecording(file)
    channels = [channel for channel in recording.channels if channel.topic == "/map"]
    results = [each.stamp_ns for each in recording.newest(channels, START_NS + ns(90))]
    is_over.set()
    recording.close()
    assert results == [START_NS + ns(1.5)]


def test_a_message_with_invalid_text_is_skipped(tmp_path: Path) -> None:
    (file,) = files(strings(0, 1, 2).write(tmp_path / "run", StoragePlugin.SQLITE3), ".db3")
    with closing(sqlite3.connect(file)) as db, db:
        db.execute("UPDATE messages SET data = CAST(x'ff' AS TEXT) WHERE id = 2")
    recording = SqliteRecording(file)
    result = recording.messages(recording.channels, START_NS, START_NS + ns(2))
    assert [each.stamp_ns - START_NS for each in result] == [0, ns(2)]
    assert "the database is damaged" in str(recording.losses)
    recording.close()
