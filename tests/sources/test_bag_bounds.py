"""Bags that claim or unfold to more than a machine has: bounded, and the rest is shown."""

from __future__ import annotations

import sqlite3
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import lz4.frame
import pytest
import zstandard
from bags import files, strings
from mcap_files import Chunk, mcap, message, packed, plain, words
from rosbags.rosbag2 import CompressionMode, StoragePlugin

from tests.sources.conftest import PlayedBag
from webviz.data.recordings import unpacking
from webviz.data.recordings.mcap import McapRecording
from webviz.data.recordings.unpacking import MAX_BYTES
from webviz.sources.bag.history import BagError

GIB = 1 << 30
EXTRA_MB = 700
"""Memory that reading may take: a chunk of the largest size, and its packed and joined parts."""


@pytest.fixture(scope="module")
def zeros() -> dict[str, bytes]:
    """4.3 GB of zeros by compression; what they claim is up to the chunk around them."""
    block = bytes(64 << 20)
    compressor = zstandard.ZstdCompressor(write_content_size=False)
    return {
        "zstd": compressor.compress(block) * 67,
        "lz4": lz4.frame.compress(bytes(16 << 20)) * 268,
    }


def read_in_little_memory(path: Path) -> str:
    """Play a bag in a process with little memory; what it says."""
    code = (
        "import resource, sys\n"
        "from pathlib import Path\n"
        "from webviz.api.declared import Topic\n"
        "from webviz.sources import Subscription\n"
        "from webviz.sources.bag.history import BagHistory\n"
        "from webviz.sources.player import Player\n"
        "used = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        f"resource.setrlimit(resource.RLIMIT_AS, (used + ({EXTRA_MB} << 20),) * 2)\n"
        "bag = Player(BagHistory(Path(sys.argv[1])))\n"
        "bag.want({'/words': Subscription('std_msgs/msg/String', Topic('/words'))})\n"
        "while bag.reached_ns < bag.history.end_ns: bag.play_until(bag.history.end_ns)\n"
        "print(len(bag.inbox.drain().get('/words', ())), *bag.warnings)\n"
    )
    completed = subprocess.run(
        [sys.executable, "-c", code, str(path)], capture_output=True, text=True, timeout=60
    )
    assert completed.returncode == 0, completed.stderr
    return completed.stdout


@pytest.mark.parametrize("claimed", [300, MAX_BYTES, 4 * GIB, 2**64 - 1])
@pytest.mark.parametrize("compression", ["zstd", "lz4"])
@pytest.mark.parametrize("with_summary", [True, False])
def test_a_chunk_that_unfolds_to_more_than_memory(
    tmp_path: Path,
    open_bag: Callable[..., PlayedBag],
    monkeypatch: pytest.MonkeyPatch,
    zeros: dict[str, bytes],
    compression: str,
    claimed: int,
    with_summary: bool,
) -> None:
    # The largest size is tried with real memory below; here only the bound.
    monkeypatch.setattr("webviz.data.recordings.mcap_chunks.MAX_BYTES", 8 << 20)
    bomb = Chunk(zeros[compression], min(claimed, 2**64 - 1), compression, (3, 5))
    file = tmp_path / "bomb.mcap"
    file.write_bytes(mcap([plain(0, 1), bomb, plain(7, 9)], with_summary=with_summary))
    bag = open_bag(file)
    bag.want("/words")
    bag.source.play_until(9)
    assert bag.texts() == ["0", "1", "7", "9"]
    (warning,) = bag.source.warnings
    assert warning.startswith("bomb.mcap is damaged: 1 chunk is incomplete (it ")
    assert warning.endswith("; everything else is shown.")
    assert "  " not in warning


@pytest.mark.parametrize("claimed", [300, MAX_BYTES])
def test_memory_stays_bounded_for_real(
    tmp_path: Path, zeros: dict[str, bytes], claimed: int
) -> None:
    file = tmp_path / "bomb.mcap"
    bomb = Chunk(zeros["zstd"], claimed, "zstd", (3, 5))
    file.write_bytes(mcap([plain(0, 1), bomb, plain(7, 9)]))
    assert file.stat().st_size < 500_000
    assert read_in_little_memory(file).startswith("4 bomb.mcap is damaged: 1 chunk")


def test_chunks_of_one_time_are_not_all_unpacked_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.data.recordings.mcap.MAX_OPEN", 1000)
    file = tmp_path / "wide.mcap"
    data = words(0, 9)
    chunks = [Chunk(packed(data, "zstd"), len(data), "zstd", (0, 9)) for _ in range(100)]
    file.write_bytes(mcap(chunks))
    recording = McapRecording(file)
    unpacked = []
    monkeypatch.setattr(
        "webviz.data.recordings.mcap.contents_of",
        lambda chunk, file: unpacked.append(chunk) or (data, ""),
    )
    messages = recording.messages(recording.channels, 0, 9)
    next(messages)
    assert 1 <= len(unpacked) <= 1000 // len(data)
    assert len(list(messages)) == 199
    recording.close()


@pytest.mark.parametrize("with_size", [True, False])
@pytest.mark.parametrize("frames", [1, 3])
@pytest.mark.parametrize("compression", ["", "zstd", "lz4"])
def test_honest_chunks_open_however_they_are_packed(
    tmp_path: Path,
    open_bag: Callable[..., PlayedBag],
    compression: str,
    frames: int,
    with_size: bool,
) -> None:
    file = tmp_path / "good.mcap"
    chunk = plain(*range(100), compression=compression, frames=frames, with_size=with_size)
    file.write_bytes(mcap([chunk]))
    bag = open_bag(file)
    bag.want("/words")
    bag.source.play_until(99)
    assert bag.texts() == [str(number) for number in range(100)]
    assert bag.source.warnings == []


def test_a_large_chunk_opens(tmp_path: Path, open_bag: Callable[..., PlayedBag]) -> None:
    file = tmp_path / "large.mcap"
    data = words(0) + message(3, bytes(96 << 20))
    file.write_bytes(mcap([Chunk(packed(data, "zstd"), len(data), "zstd", (0, 3))]))
    bag = open_bag(file)
    bag.want("/words")
    bag.source.play_until(3)
    (large,) = bag.source.inbox.drain()["/words"]  # by its bytes the only one that is kept
    assert len(large.cdr) == 96 << 20
    assert bag.source.warnings == []


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_message_that_unfolds_to_more_than_memory(
    tmp_path: Path,
    open_bag: Callable[..., PlayedBag],
    monkeypatch: pytest.MonkeyPatch,
    zeros: dict[str, bytes],
    storage: StoragePlugin,
) -> None:
    monkeypatch.setattr(unpacking, "MAX_BYTES", 8 << 20)
    recorded = strings(0, 2)
    recorded.put(1, "/words", zeros["zstd"])
    bag = open_bag(recorded.write(tmp_path / "bag", storage))
    assert bag.words_until(2) == ["0", "2"]
    (warning,) = bag.source.warnings
    assert "it expands to more than 8 388 608 bytes" in warning


def test_a_file_that_unfolds_to_more_than_the_limit(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(unpacking, "MAX_FILE", 1 << 20)
    (file,) = files(strings(0, 1).write(tmp_path / "bag"), ".mcap")
    packed_file = tmp_path / "run.mcap.zst"
    packed_file.write_bytes(zstandard.compress(file.read_bytes() + bytes(4 << 20)))
    bag = open_bag(packed_file)
    assert bag.words_until(1) == ["0", "1"]
    assert "it expands to more than 1 048 576 bytes" in bag.source.warnings[0]


def test_unpacking_leaves_room_on_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unpacking, "KEPT_FREE", 1 << 60)
    packed_file = tmp_path / "run.mcap.zst"
    packed_file.write_bytes(zstandard.compress(bytes(4 << 20)))
    target, fault = unpacking.unpack_file(packed_file, "zstd", tmp_path)
    assert target.stat().st_size == 0
    assert fault


def test_a_database_that_computes_its_messages(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    (file,) = files(strings(0, 1).write(tmp_path / "bag", StoragePlugin.SQLITE3), ".db3")
    database = sqlite3.connect(file)
    database.executescript(
        "ALTER TABLE messages RENAME TO old;"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, few,"
        " data GENERATED ALWAYS AS (coalesce(few, zeroblob(900000000))));"
        "INSERT INTO messages SELECT id, topic_id, timestamp, data FROM old;"
        "INSERT INTO messages SELECT 3, topic_id, timestamp, NULL FROM old WHERE id = 2;"
    )
    database.close()
    bag = open_bag(file)
    assert bag.words_until(1) == ["0", "1"]
    (warning,) = bag.source.warnings
    assert warning == (
        "bag.db3 is damaged: 1 message is skipped (the database is damaged); everything else is "
        "shown."
    )


def test_messages_that_are_a_view_are_refused(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    file = tmp_path / "view.db3"
    database = sqlite3.connect(file)
    database.executescript(
        "CREATE TABLE topics(id, name, type, serialization_format);"
        "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM n)"
        " SELECT id, 1 AS topic_id, id AS timestamp, zeroblob(1000000) AS data FROM n;"
    )
    database.close()
    with pytest.raises(BagError, match="is not a bag"):
        open_bag(file)


def test_compressed_files_and_messages_of_ros_still_open(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    for mode in (CompressionMode.FILE, CompressionMode.MESSAGE):
        bag = open_bag(strings(0, 1).write(tmp_path / mode.name, StoragePlugin.SQLITE3, mode))
        assert bag.words_until(1) == ["0", "1"]
