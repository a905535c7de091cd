"""Bags that cannot be read: one sentence that ends with what to do."""

from __future__ import annotations

import random

import pytest
from bags import Bag, files, strings
from rosbags.rosbag2 import CompressionMode, StoragePlugin

from webviz.engine.sources.bag import BagError, BagSource

ZSTD = b"\x28\xb5\x2f\xfd"
"""What compressed data begins with."""


def refusal(path) -> str:
    with pytest.raises(BagError) as caught:
        BagSource(path)
    text = str(caught.value)
    assert str(path) in text
    assert "\n" not in text
    return text


def test_a_bag_that_is_not_there(tmp_path):
    assert "not found" in refusal(tmp_path / "nowhere.mcap")


def test_a_folder_without_metadata(tmp_path):
    folder = strings(0).write(tmp_path / "bag")
    (folder / "metadata.yaml").unlink()
    assert f"ros2 bag reindex {folder}" in refusal(folder)


@pytest.mark.parametrize("text", ["", "[", "rosbag2_bagfile_information: 3", "a: b"])
def test_a_folder_with_broken_metadata(tmp_path, text):
    folder = strings(0).write(tmp_path / "bag")
    (folder / "metadata.yaml").write_text(text)
    assert f"ros2 bag reindex {folder}" in refusal(folder)


def test_a_folder_whose_file_is_missing(tmp_path):
    folder = strings(0).write(tmp_path / "bag")
    for file in files(folder, ".mcap"):
        file.unlink()
    assert f"ros2 bag reindex {folder}" in refusal(folder)


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_folder_whose_only_file_was_renamed_is_read(tmp_path, opened, storage):
    folder = strings(0, 1).write(tmp_path / "bag", storage)
    file = next(each for each in folder.iterdir() if each.suffix != ".yaml")
    file.rename(file.with_stem("renamed"))
    bag = opened(folder)
    assert bag.source.remarks == [
        f"{file.name}, named by metadata.yaml, is missing. Reading renamed{file.suffix}."
    ]
    bag.want("/words")
    bag.play(1)
    assert bag.heard() == ["0", "1"]


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
@pytest.mark.parametrize("lost", ["deadline:", "depth:", "durability:", "history:"])
def test_a_qos_profile_may_lack_a_policy(tmp_path, opened, storage, lost):
    folder = strings(0, 1, best_effort=True).write(tmp_path / "bag", storage)
    for file in folder.iterdir():  # the length must not change
        other = f"_{lost[1:]}"
        file.write_bytes(file.read_bytes().replace(lost.encode(), other.encode()))
    bag = opened(folder)
    (publisher,) = bag.source.offers()["/words"].publishers
    assert publisher.reliability == "best_effort"
    bag.want("/words")
    bag.play(1)
    assert bag.heard() == ["0", "1"]


def test_an_unreadable_qos_profile_is_left_out(tmp_path, opened):
    (file,) = files(strings(0, 1).write(tmp_path / "bag"), ".mcap")
    file.write_bytes(file.read_bytes().replace(b"history:", b"[history"))
    bag = opened(file)
    bag.want("/words")
    bag.play(1)
    assert bag.heard() == ["0", "1"]


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.97])
def test_an_mcap_file_that_was_cut_off(tmp_path, share):
    (file,) = files(strings(*range(50)).write(tmp_path / "bag"), ".mcap")
    data = file.read_bytes()
    file.write_bytes(data[: int(share * len(data))])
    assert f"mcap recover {file}" in refusal(file)


def test_a_database_that_was_cut_off(tmp_path):
    recorded = strings(*range(2000))
    (file,) = files(recorded.write(tmp_path / "bag", StoragePlugin.SQLITE3), ".db3")
    file.write_bytes(file.read_bytes()[:3000])
    assert f"sqlite3 {file} .recover" in refusal(file)


def test_a_file_of_something_else(tmp_path):
    mcap, text = tmp_path / "run.mcap", tmp_path / "run.txt"
    for file in (mcap, text):
        file.write_text("This is not what it seems to be, however long it may go on.\n" * 9)
    assert "mcap recover" in refusal(mcap)
    assert "is not a bag" in refusal(text)


def test_a_bag_of_ros_1(tmp_path):
    file = tmp_path / "old.bag"
    file.write_bytes(b"#ROSBAG V2.0\n")
    assert "rosbags-convert" in refusal(file)


def test_an_empty_bag(tmp_path):
    empty = Bag()
    empty.add("/words", "std_msgs/msg/String")
    assert "contains no messages" in refusal(empty.write(tmp_path / "bag"))


def test_damage_in_the_middle_is_told_after_what_comes_before(tmp_path, opened):
    recorded = strings(*(0.01 * i for i in range(40)))
    recorded.add("/large", "std_msgs/msg/String")
    noise = random.Random(1)
    for at_s in (1, 2, 3):
        recorded.put(at_s, "/large", {"data": noise.randbytes(1 << 20).hex()})
    folder = recorded.write(tmp_path / "bag", StoragePlugin.MCAP, CompressionMode.STORAGE)
    (file,) = files(folder, ".mcap")
    data = bytearray(file.read_bytes())
    last_chunk = data.rindex(ZSTD)
    data[last_chunk : last_chunk + 4] = bytes(4)
    file.write_bytes(bytes(data))
    bag = opened(file)
    bag.want("/words", "/large")
    with pytest.raises(BagError, match="damaged or cut off"):
        bag.play(3)
    assert len(bag.heard()) == 40
