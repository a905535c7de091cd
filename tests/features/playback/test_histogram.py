"""Counts of messages over time, which the index of a bag has."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from bags import START_NS, Bag, ns, strings
from rosbags.rosbag2 import CompressionMode, StoragePlugin

from webviz.data.recordings import open_recording
from webviz.data.recordings.recording import TimeParts
from webviz.features.playback.stores import density_store
from webviz.sources.bag.history import BagHistory
from webviz.sources.past_state import PlaybackState

PARTS = 50


def counted(path: Path) -> tuple[dict[str, list[int]], dict[str, list[int]]]:
    """The histogram of a bag, and that of all of its messages."""
    recording = open_recording(path)
    assert recording.span_ns is not None
    parts = TimeParts(*recording.span_ns, PARTS)
    counts = {c.topic: each.tolist() for c, each in recording.histogram(parts).items()}
    truth = Counter(
        (entry.channel.topic, (entry.stamp_ns - parts.start_ns) // parts.length_ns)
        for entry in recording.messages(recording.channels, *recording.span_ns)
    )
    recording.close()
    return counts, {topic: [truth[topic, part] for part in range(PARTS)] for topic in counts}


def bag_of(size: int) -> Bag:
    """Ten seconds of two topics, one of them with a gap, and one without messages."""
    bag = strings()
    bag.add("/silent", "std_msgs/msg/String")
    bag.add("/large", "std_msgs/msg/String")
    for tenths in range(101):
        if not 30 < tenths < 60:
            bag.put(tenths / 10, "/words", {"data": "a"})
        bag.put(tenths / 10, "/large", {"data": "b" * size})
    return bag


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
@pytest.mark.parametrize("compression", [CompressionMode.NONE, CompressionMode.FILE])
def test_the_index_knows_how_many_messages_come_when(
    tmp_path: Path, storage: StoragePlugin, compression: CompressionMode
) -> None:
    counts, truth = counted(bag_of(100).write(tmp_path / "run", storage, compression))
    assert counts == truth
    assert sum(counts["/words"]) == 72
    assert counts["/words"][20] == 0
    assert not any(counts["/silent"])


def test_chunks_are_counted_without_reading_their_index(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = bag_of(400_000).write(tmp_path / "run")
    exact, truth = counted(path)
    assert exact == truth
    monkeypatch.setattr("webviz.data.recordings.mcap.MAX_INDEX", 0)
    spread, _ = counted(path)
    assert {topic: sum(counts) for topic, counts in spread.items()} == {
        topic: sum(counts) for topic, counts in truth.items()
    }
    assert max(abs(a - b) for a, b in zip(spread["/large"], truth["/large"], strict=True)) <= 1


def test_a_file_without_an_index_is_counted_too(tmp_path: Path) -> None:
    (file,) = bag_of(100).write(tmp_path / "run").glob("*.mcap")
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(file.read_bytes()[:-1000])  # without its summary
    counts, _ = counted(cut)
    assert sum(counts["/words"]) == 72


def test_a_worker_counts_all_bags(tmp_path: Path, theater: Callable) -> None:
    paths = [strings(0, 1).write(tmp_path / "a"), strings(9, topic="/more").write(tmp_path / "b")]
    viewer = theater(paths)
    viewer.turn_until(lambda: bool(viewer.loop.state().recorded))
    recorded = viewer.loop.state().recorded
    assert {topic: sum(counts) for topic, counts in recorded.items()} == {"/words": 2, "/more": 1}
    assert recorded["/more"][-1] == 1
    assert viewer.loop.state().recorded is recorded


def test_topics_without_messages_are_known(tmp_path: Path) -> None:
    for storage in (StoragePlugin.MCAP, StoragePlugin.SQLITE3):
        source = BagHistory(bag_of(10).write(tmp_path / storage.name, storage))
        assert [source.has(topic) for topic in ("/words", "/silent")] == [True, False]
        source.close()


def test_a_span_shorter_than_its_parts_is_counted(tmp_path: Path) -> None:
    bag = strings(0, 0)
    counts, truth = counted(bag.write(tmp_path / "run"))
    assert counts == truth
    assert TimeParts(START_NS, START_NS + ns(1e-9), PARTS).length_ns == 1


@pytest.mark.parametrize(
    ("span_ns", "expected"),
    [
        ((2**63 - 2, 2**63 + 5), [0, 0, 0, 1, 3, 3]),
        ((0, 2**64 - 1), [0, 0, 1, 2, 2, 3]),
        ((-4, 3), [2, 3, 3, 3, 3, 3]),
        ((-9, -2), [3, 3, 3, 3, 3, 3]),
    ],
)
def test_parts_of_any_time_that_a_file_may_have(
    span_ns: tuple[int, int], expected: list[int]
) -> None:
    stamps = np.array([0, 2, 2**63 - 3, 2**63, 2**63 + 5, 2**64 - 1], np.uint64)
    assert TimeParts(*span_ns, 4).part_of(stamps).tolist() == expected


def test_a_memory_without_messages_has_no_span_that_moves_on() -> None:
    def state(now_s: float) -> PlaybackState:
        return PlaybackState(
            names=(),
            start_ns=0,
            end_ns=ns(now_s),
            position_s=now_s,
            rate=1.0,
            is_playing=True,
            is_seeking=False,
            loop=False,
            selected=None,
            counted=(now_s, now_s),
        )

    assert density_store(state(37.5), {}) == density_store(state(39.5), {})
    full = density_store(state(39.5), {"/words": [1, 2], "/large": [0, 4]})
    assert (full.counts, full.first, full.last) == ([1, 6], 39.5, 39.5)
