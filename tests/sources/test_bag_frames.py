"""The frames of a bag, before anything is played."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from bags import TF, Bag, stamped

from tests.sources.conftest import PlayedBag
from webviz.sources.bag import history as bag_frames
from webviz.sources.bag.history import BagHistory

POSE = "geometry_msgs/msg/PoseStamped"


@pytest.fixture
def source(tmp_path: Path, open_bag: Callable[..., PlayedBag]) -> BagHistory:
    """Return a bag with frames of all kinds, and messages that cannot be read."""
    bag = Bag()
    bag.add("/tf", TF)
    bag.put(0, "/tf", b"\0\1\0\0\7")
    both = [stamped("/map", "/odom", 1), stamped("odom", "base", 1)]
    bag.put(1, "/tf", {"transforms": both})
    bag.put(2, "/tf", {"transforms": both[1:]})
    bag.transform(3, "base", "laser", static=True)
    for topic, frames in (("/a", ["/late", "", "late", "map"]), ("/b", ["odom"])):
        bag.add(topic, POSE)
        for second, frame in enumerate(frames):
            bag.put(second, topic, {"header": {"frame_id": frame}})
    bag.put(0, "/a", b"\0\1\0\0\7")
    bag.add("/silent", POSE)
    history = open_bag(bag.write(tmp_path / "bag")).source.history
    assert isinstance(history, BagHistory)
    return history


def test_links_are_those_of_all_transforms_the_static_ones_first(source: BagHistory) -> None:
    assert source.links() == [("base", "laser"), ("map", "odom"), ("odom", "base")]


def test_frames_are_those_of_the_requested_topics(source: BagHistory) -> None:
    assert source.frames(["/a"]) == ["late", "map"]
    assert sorted(source.frames(["/a", "/b", "/silent", "/none"])) == ["late", "map", "odom"]
    assert source.frames([]) == []


def test_only_the_first_messages_are_read(
    source: BagHistory, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bag_frames, "MAX_READ", 2)
    assert source.links() == [("base", "laser"), ("map", "odom"), ("odom", "base")]
    assert source.frames(["/a"]) == ["late"]
    monkeypatch.setattr(bag_frames, "MAX_READ", 1)
    assert source.links() == [("base", "laser")]
