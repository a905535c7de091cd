"""Recently drawn pictures: newest first, bounded in time and bytes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from webviz import Points
from webviz.engine.pipeline import scene_diff
from webviz.engine.pipeline.picking import SceneSnapshot
from webviz.engine.pipeline.scene_diff import KEPT_S, MAX_SNAPSHOTS, RecentSnapshots


def snapshot(count: int = 1) -> SceneSnapshot:
    """Return a drawn picture of so many points, of 15 bytes each."""
    node = Points(np.zeros((count, 3), np.float32), np.zeros((count, 3), np.uint8), 0.1)
    groups = cast(Any, {"": SimpleNamespace(nodes={"points": node})})
    return SceneSnapshot(groups, (), "map")


def test_the_newest_comes_first() -> None:
    recent = RecentSnapshots(lambda: 0.0)
    snapshots = [snapshot() for _ in range(3)]
    for each in snapshots:
        recent.keep("a", each)
    recent.keep("b", snapshot())
    assert [id(each) for each in recent.of("a")] == [id(each) for each in reversed(snapshots)]


def test_the_oldest_go_when_there_are_too_many_bytes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scene_diff, "MAX_BYTES", 15 * 250)
    recent = RecentSnapshots(lambda: 0.0)
    snapshots = [snapshot(100) for _ in range(5)]
    for number, each in enumerate(snapshots):
        recent.keep("a", each)
        assert len(list(recent.of("a"))) == min(number + 1, 2)
    assert [id(each) for each in recent.of("a")] == [id(snapshots[4]), id(snapshots[3])]
    recent.keep("a", snapshot(1000))
    assert list(recent.of("a")) == []
    recent.keep("a", snapshot())  # the bytes of what is gone count no more
    assert len(list(recent.of("a"))) == 1


def test_the_oldest_go_when_there_are_too_many() -> None:
    recent = RecentSnapshots(lambda: 0.0)
    snapshots = [snapshot() for _ in range(MAX_SNAPSHOTS + 1)]
    for each in snapshots:
        recent.keep("a", each)
    assert [id(each) for each in recent.of("a")] == [id(each) for each in reversed(snapshots[1:])]


def test_snapshots_expire() -> None:
    now = 1000.0
    recent = RecentSnapshots(lambda: now)
    recent.keep("a", snapshot())
    now = 1000.0 + KEPT_S - 0.1
    assert len(list(recent.of("a"))) == 1
    now = 1000.0 + KEPT_S + 0.1
    assert list(recent.of("a")) == []
