"""Bags that cannot be read: one sentence that ends with what to do."""

from __future__ import annotations

import contextlib
import gc
import random
import re
import sqlite3
from collections.abc import Callable, Sequence
from pathlib import Path
from zlib import crc32

import pytest
import zstandard
from bags import TF, Bag, files, strings
from mcap_files import STRING, Chunk, mcap, message, packed
from rosbags.rosbag2 import CompressionMode, StoragePlugin

from tests.sources.conftest import PlayedBag
from webviz.data.messages import DecodeError, decode
from webviz.data.recordings import open_recording
from webviz.data.recordings.recording import END_MISSING, Losses
from webviz.data.recordings.sqlite_times import damaged
from webviz.sources.bag.history import BagError, BagHistory
from webviz.sources.player import Player

ZSTD = b"\x28\xb5\x2f\xfd"
"""First bytes of compressed data."""
DAMAGED = Path(__file__).parents[3] / "shared/data/bags/damaged"


def refusal(path: Path) -> str:
    with pytest.raises(BagError) as excinfo:
        Player(BagHistory(path))
    text = str(excinfo.value)
    assert str(path) in text
    assert "\n" not in text
    return text


def test_a_bag_that_is_not_there(tmp_path: Path) -> None:
    assert "not found" in refusal(tmp_path / "nowhere.mcap")


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_folder_without_metadata_is_read_as_one_that_is_still_recorded(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], storage: StoragePlugin
) -> None:
    folder = strings(0, 1).write(tmp_path / "bag", storage)
    (folder / "metadata.yaml").unlink()
    (file,) = folder.iterdir()
    bag = open_bag(folder)
    assert bag.words_until(1) == ["0", "1"]
    assert bag.source.warnings == [
        "bag has no metadata.yaml: it is still being recorded, or its recorder was interrupted. "
        f"Reading {file.name}."
    ]


@pytest.mark.parametrize("text", ["", "[", "rosbag2_bagfile_information: 3", "a: b"])
def test_a_folder_with_broken_metadata(tmp_path: Path, text: str) -> None:
    folder = strings(0).write(tmp_path / "bag")
    (folder / "metadata.yaml").write_text(text)
    assert f"ros2 bag reindex {folder}" in refusal(folder)


def test_a_folder_whose_file_is_missing(tmp_path: Path) -> None:
    folder = strings(0).write(tmp_path / "bag")
    for file in files(folder, ".mcap"):
        file.unlink()
    assert f"ros2 bag reindex {folder}" in refusal(folder)


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_bag_is_closed_while_being_read(tmp_path: Path, storage: StoragePlugin) -> None:
    recording = open_recording(strings(0, 1, 2).write(tmp_path / "bag", storage))
    assert recording.span_ns is not None
    messages = recording.messages(recording.channels, *recording.span_ns)
    next(messages)
    recording.close()
    del messages  # an exception here fails the test as a warning
    gc.collect()


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_folder_whose_only_file_was_renamed_is_read(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], storage: StoragePlugin
) -> None:
    folder = strings(0, 1).write(tmp_path / "bag", storage)
    file = next(each for each in folder.iterdir() if each.suffix != ".yaml")
    file.rename(file.with_stem("renamed"))
    bag = open_bag(folder)
    assert bag.source.warnings == [
        f"{file.name}, named by metadata.yaml, is missing. Reading renamed{file.suffix}."
    ]
    assert bag.words_until(1) == ["0", "1"]


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
@pytest.mark.parametrize("key", ["deadline:", "depth:", "durability:", "history:"])
def test_a_qos_profile_may_lack_a_policy(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], storage: StoragePlugin, key: str
) -> None:
    folder = strings(0, 1, best_effort=True).write(tmp_path / "bag", storage)
    for file in folder.iterdir():  # the length must not change
        other = f"_{key[1:]}"
        file.write_bytes(file.read_bytes().replace(key.encode(), other.encode()))
    bag = open_bag(folder)
    (publisher,) = bag.source.offers()["/words"].publishers
    assert publisher.reliability == "best_effort"
    assert bag.words_until(1) == ["0", "1"]


def test_an_unreadable_qos_profile_is_left_out(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    (file,) = files(strings(0, 1).write(tmp_path / "bag"), ".mcap")
    file.write_bytes(file.read_bytes().replace(b"history:", b"[history"))
    bag = open_bag(file)
    assert bag.words_until(1) == ["0", "1"]


@pytest.mark.parametrize("share", [0.0, 0.01, 0.1])
def test_an_mcap_file_without_a_whole_message(tmp_path: Path, share: float) -> None:
    (file,) = files(strings(*range(50)).write(tmp_path / "bag"), ".mcap")
    data = file.read_bytes()
    file.write_bytes(data[: int(share * len(data))])
    text = refusal(file)
    assert (
        "no message in it is whole" in text or "is empty (0 bytes)" in text or "not a bag" in text
    )


@pytest.mark.parametrize("size", [16, 31, 32])
def test_a_database_that_ends_within_its_header(tmp_path: Path, size: int) -> None:
    (file,) = files(strings(0).write(tmp_path / "bag", StoragePlugin.SQLITE3), ".db3")
    file.write_bytes(file.read_bytes()[:size])
    assert f"{file} is damaged (" in refusal(file)


@pytest.mark.parametrize("compression", [CompressionMode.NONE, CompressionMode.STORAGE])
def test_a_truncated_mcap_file_is_shown_up_to_its_end(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], compression: CompressionMode
) -> None:
    recorded = _noisy(300)
    (file,) = files(recorded.write(tmp_path / "bag", StoragePlugin.MCAP, compression), ".mcap")
    data = file.read_bytes()
    counts = []
    for share in (0.3, 0.6, 0.9, 0.999):
        file.write_bytes(data[: int(share * len(data))])
        bag = open_bag(file)
        assert bag.source.warnings == [
            f"{file.name} has no end: it is still being recorded or was cut off. What it "
            "contained when it was opened is shown. Once its recorder has ended, `webviz recover` "
            "completes a copy."
        ]
        bag.want("/noise")
        bag.play(300)
        counts.append(_beginning(recorded, bag.texts("/noise")))
    assert counts == sorted(counts)
    assert counts[0] > 60
    assert counts[-1] == 300


def test_complete_pages_of_a_truncated_database_are_shown(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    recorded = _noisy(300)
    (file,) = files(recorded.write(tmp_path / "bag", StoragePlugin.SQLITE3), ".db3")
    data = file.read_bytes()
    counts = []
    for share in (0.3, 0.6, 0.9):
        file.write_bytes(data[: int(share * len(data))])
        bag = open_bag(file)
        bag.want("/noise")
        bag.play(300)
        texts = bag.texts("/noise")
        # Pages of a later message may come before those of an earlier one.
        assert texts == [text for text in _texts(recorded) if text in set(texts)]
        counts.append(len(texts))
        (warning,) = bag.source.warnings
        assert warning.startswith((f"{file.name} is damaged: ", f"{file.name} has no end: "))
    assert counts == sorted(counts)
    assert counts[0] > 60


def test_a_database_without_a_whole_table(tmp_path: Path) -> None:
    (file,) = files(strings(*range(2000)).write(tmp_path / "bag", StoragePlugin.SQLITE3), ".db3")
    file.write_bytes(file.read_bytes()[:3000])
    assert f"sqlite3 {file} .recover" in refusal(file)


@pytest.mark.parametrize("kind", ["", "zstd", "lz4", "no summary", "no chunks", "db3"])
def test_one_flipped_bit_loses_little(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], kind: str
) -> None:
    recorded = _noisy(60)
    expected = _texts(recorded)
    parts = [b"".join(message(i, expected[i]) for i in range(j, j + 10)) for j in range(0, 60, 10)]
    how = kind if kind in ("zstd", "lz4") else ""
    chunks = [
        Chunk(packed(part, how), len(part), how, (10 * j, 10 * j + 9), crc32(part))
        for j, part in enumerate(parts)
    ]
    if kind == "db3":
        folder = recorded.write(tmp_path / "bag", StoragePlugin.SQLITE3)
        (file,) = files(folder, ".db3")
        good = file.read_bytes()
    else:
        file = tmp_path / "bag.mcap"
        has_summary = kind not in ("no summary", "no chunks")
        good = mcap(parts if kind == "no chunks" else chunks, with_summary=has_summary)
    # Without checksums no reader notices a change within a message, or of its kind of record.
    wrong = 1 if kind in ("db3", "no chunks") else 0
    noise, least = random.Random(5), 60
    # The first pages of a database, and names of topics at the beginning, have no copy.
    first = 20_000 if kind == "db3" else 150
    places = [noise.randrange(first, len(good)) for _ in range(30)]
    if kind != "db3":
        places += range(len(good) - 900, len(good), 30)  # the summary
        places += [place + by for place in _starts(good) for by in (0, 1, 3, 8, 20, 30)]
    for place in places:
        data = bytearray(good)
        data[place] ^= 1 << noise.randrange(8)
        file.write_bytes(data)
        bag = open_bag(file)
        topic = "/noise" if kind == "db3" else "/words"
        bag.want(topic)
        bag.source.play_until(bag.source.history.end_ns)
        texts = []
        for raw in bag.source.inbox.drain().get(topic, ()):
            try:
                texts.append(decode(STRING, raw.cdr).data)
            except DecodeError:
                texts.append("wrong")
        assert len(set(texts) - set(expected)) <= wrong, place
        if len(texts) < 60 - wrong:
            assert "is damaged" in bag.source.warnings[0], place
        least = min(least, len(texts))
        bag.source.close()
    assert least >= 50  # one of six chunks


def _starts(data: bytes) -> list[int]:
    """Return where some records of chunks or messages begin."""
    results = [match.start() for match in re.finditer(rb"[\x05\x06].[\x02-\xff].\0{5}", data, re.S)]
    return results[1:-1:7] if len(results) > 20 else results[1:-1]


def _noisy(count: int, kilobytes: int = 8) -> Bag:
    """Strings that do not compress well, one each second."""
    recorded, noise = Bag(), random.Random(2)
    recorded.add("/noise", "std_msgs/msg/String")
    for at_s in range(count):
        recorded.put(at_s, "/noise", {"data": noise.randbytes(kilobytes << 9).hex()})
    return recorded


def _beginning(recorded: Bag, texts: Sequence[str]) -> int:
    """Return the number of messages received, which are the first of the recording."""
    assert list(texts) == _texts(recorded)[: len(texts)]
    return len(texts)


def _texts(recorded: Bag) -> list[str]:
    return [values["data"] for _, _, values in recorded.messages if isinstance(values, dict)]


@pytest.mark.parametrize("name", ["run.mcap", "run.db3", "run.txt"])
@pytest.mark.parametrize(
    ("content", "named"),
    [
        (b"", "is empty (0 bytes)"),
        (b"This is not what it seems to be, however long it may go on.\n" * 9, "is a text, not"),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:12\n", "run `git lfs pull`"),
        (b"#ROSBAG V2.0\n", "no message in it is whole"),
        (bytes(range(256)) * 9, "is not a bag"),
        (zstandard.compress(b"hello"), "is a text, not a bag"),
        (zstandard.compress(zstandard.compress(b"hello")), "is compressed twice"),
        (zstandard.compress(random.Random(1).randbytes(999))[:500], "is not a bag"),
    ],
)
def test_other_kinds_of_files_are_refused_by_their_kind(
    tmp_path: Path, name: str, content: bytes, named: str
) -> None:
    file = tmp_path / name
    file.write_bytes(content)
    assert named in refusal(file)


@pytest.mark.parametrize("name", ["run", "run.bag", "run.mcap", "run.db3"])
@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_bag_under_any_name_is_read(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], storage: StoragePlugin, name: str
) -> None:
    folder = strings(0, 1).write(tmp_path / "bag", storage)
    (file,) = [each for each in folder.iterdir() if each.suffix != ".yaml"]
    bag = open_bag(file.rename(tmp_path / name))
    assert bag.words_until(1) == ["0", "1"]


@pytest.mark.parametrize("name", ["run.mcap.zst", "run.mcap.zstd", "run.db3.zstd"])
def test_a_compressed_file_is_read(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], name: str
) -> None:
    storage = StoragePlugin.MCAP if "mcap" in name else StoragePlugin.SQLITE3
    folder = strings(0, 1).write(tmp_path / "bag", storage)
    (file,) = [each for each in folder.iterdir() if each.suffix != ".yaml"]
    packed = tmp_path / name
    packed.write_bytes(zstandard.compress(file.read_bytes()))
    bag = open_bag(packed)
    assert bag.words_until(1) == ["0", "1"]
    assert bag.source.warnings == []


def test_a_folder_of_several_files_is_read_without_those_that_are_missing_or_broken(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    folder = strings(0, 1).write(tmp_path / "bag")
    (first,) = files(folder, ".mcap")
    (second,) = files(strings(2, 3).write(tmp_path / "more"), ".mcap")
    second.rename(folder / "bag_2.mcap")
    (folder / "bag_1.mcap").touch()
    metadata = folder / "metadata.yaml"
    names = f"- {first.name}\n  - bag_1.mcap\n  - bag_2.mcap\n  - bag_3.mcap\n"
    metadata.write_text(metadata.read_text().replace(f"- {first.name}\n", names))
    bag = open_bag(folder)
    assert bag.words_until(3) == ["0", "1", "2", "3"]
    assert bag.source.warnings == [
        "bag_3.mcap, named by metadata.yaml, is missing. Reading "
        f"{first.name}, bag_1.mcap, bag_2.mcap.",
        "bag_1.mcap is empty (0 bytes). Copy it again, or choose another bag.",
        "bag is damaged: bag_1.mcap cannot be read; everything else is shown.",
    ]


def test_losses_within_the_files_of_a_folder_are_reported(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    folder = strings(*range(400)).write(tmp_path / "bag", StoragePlugin.SQLITE3)
    (file,) = files(folder, ".db3")
    file.write_bytes(file.read_bytes()[: int(file.stat().st_size * 0.7)])
    bag = open_bag(folder)
    bag.want("/words")
    bag.play(400)
    (warning,) = bag.source.warnings
    assert warning.startswith(f"bag is damaged: in {file.name} ")
    assert warning.endswith("its end is missing; everything else is shown.")


def test_a_folder_without_any_bag_file(tmp_path: Path) -> None:
    assert refusal(tmp_path).endswith(
        "is not a bag: it has no metadata.yaml, MCAP or db3 file. Give an MCAP or db3 file, or a "
        "rosbag2 folder."
    )


def test_metadata_that_are_a_pointer_of_git_lfs(tmp_path: Path) -> None:
    folder = strings(0).write(tmp_path / "bag")
    pointer = f"version https://git-lfs.github.com/spec/v1\noid sha256:{'a' * 64}\nsize 9\n"
    (folder / "metadata.yaml").write_text(pointer)
    assert refusal(folder).endswith("metadata.yaml is a Git LFS pointer: run `git lfs pull`.")


def test_an_empty_bag(tmp_path: Path) -> None:
    empty = Bag()
    empty.add("/words", "std_msgs/msg/String")
    assert "contains no messages" in refusal(empty.write(tmp_path / "bag"))


def test_damage_in_the_middle_is_reported_and_the_rest_is_shown(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    recorded = _noisy(60, kilobytes=40)
    folder = recorded.write(tmp_path / "bag", StoragePlugin.MCAP, CompressionMode.STORAGE)
    (file,) = files(folder, ".mcap")
    data = bytearray(file.read_bytes())
    second_chunk = data.index(ZSTD, 1 << 19)
    data[second_chunk : second_chunk + 4] = bytes(4)
    file.write_bytes(bytes(data))
    bag = open_bag(file)
    bag.want("/noise")
    bag.play(60)
    texts = bag.texts("/noise")
    expected = _texts(recorded)
    assert texts == expected[:26] + expected[52:]
    (warning,) = bag.source.warnings
    assert warning == (
        f"{file.name} is damaged: 1 chunk is incomplete (its zstd data is damaged); everything "
        "else is shown."
    )


@pytest.mark.parametrize(("name", "why"), [("flip1", "is damaged"), ("trunc70", "has no end")])
def test_the_beginning_of_a_real_damaged_bag_is_shown(
    open_bag: Callable[..., PlayedBag], name: str, why: str
) -> None:
    if not DAMAGED.exists():
        pytest.skip("shared data is missing")
    whole, bag = (
        open_bag(DAMAGED.parent / "nav2_turtlebot.mcap"),
        open_bag(DAMAGED / f"{name}.mcap"),
    )
    payloads = []
    for each in (whole, bag):
        each.want("/tf", type_name=TF)
        each.play(100)
        payloads.append([raw.cdr for raw in each.source.inbox.drain()["/tf"]])
    assert 1000 < len(payloads[1]) < len(payloads[0])
    assert payloads[1] == payloads[0][: len(payloads[1])]
    assert why in bag.source.warnings[0]


def test_an_mcap_file_that_grows_while_played_shows_the_messages_it_had_when_opened(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    recorded = _noisy(300)
    (file,) = files(recorded.write(tmp_path / "bag"), ".mcap")
    data = file.read_bytes()
    file.write_bytes(data[: len(data) // 2])
    bag = open_bag(file)
    bag.want("/noise")
    bag.play(60)
    with file.open("ab") as growing:
        growing.write(data[len(data) // 2 :])
    end_ns = bag.source.history.end_ns
    bag.source.jump(bag.source.history.start_ns)
    bag.texts("/noise")
    while bag.source.reached_ns < end_ns:
        bag.source.play_until(end_ns)
    assert bag.source.history.end_ns == end_ns
    assert 60 < _beginning(recorded, bag.texts("/noise")) < 300


@pytest.mark.parametrize("journal_mode", ["wal", "delete"])
def test_a_database_that_is_still_written_shows_its_committed_messages(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], journal_mode: str
) -> None:
    (file,) = files(strings(0, 1).write(tmp_path / "bag", StoragePlugin.SQLITE3), ".db3")
    with contextlib.closing(sqlite3.connect(file)) as recorder:
        recorder.execute(f"PRAGMA journal_mode = {journal_mode}")
        recorder.execute("PRAGMA cache_size = 1")
        copy = "INSERT INTO messages SELECT id + 2, topic_id, timestamp + 2, data FROM messages"
        recorder.execute(copy)
        if journal_mode == "wal":
            recorder.commit()
        bag = open_bag(file)
        assert bag.words_until(1) == ["0", "1"]
        (warning,) = bag.source.warnings
        assert warning.startswith(f"{file.name} has no end: it is still being recorded, or ")
        recorder.rollback()


def test_a_topic_with_invalid_qos_text_is_read(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    (file,) = files(strings(0, 1).write(tmp_path / "bag", StoragePlugin.SQLITE3), ".db3")
    with contextlib.closing(sqlite3.connect(file)) as db, db:
        db.execute("UPDATE topics SET offered_qos_profiles = CAST(x'2d0a20ff0a' AS TEXT)")
    bag = open_bag(file)
    assert bag.words_until(1) == ["0", "1"]


def test_an_error_of_sqlite_is_cited_short_and_on_one_line(tmp_path: Path) -> None:
    error = damaged(tmp_path / "bag.db3", f"malformed database schema (a\n\nb{500 * ' c'})")
    assert str(error).splitlines() == [str(error)]
    assert " (malformed database schema (a b c c" in str(error)
    assert len(str(error)) < 600


def test_several_losses_name_the_reason_of_the_first() -> None:
    losses = Losses("chunk", "incomplete", {0: "its checksum is wrong"})
    assert str(losses) == "1 chunk is incomplete (its checksum is wrong)"
    losses.skipped[9] = "its zstd data is damaged"
    losses.others.append(END_MISSING)
    assert str(losses) == (
        "2 chunks are incomplete (the first because its checksum is wrong), and its end is missing"
    )
