"""Recently drawn pictures: newest first, bounded in time and bytes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from webviz import Points
from webviz.engine.pipeline import scene_diff
from webviz.engine.pipeline.picking import Shot
from webviz.engine.pipeline.scene_diff import KEPT_S, MAX_SHOTS, Past


def shot(count: int = 1) -> Shot:
    """Return a drawn picture of so many points, of 15 bytes each."""
    node = Points(np.zeros((count, 3), np.float32), np.zeros((count, 3), np.uint8), 0.1)
    groups = cast(Any, {"": SimpleNamespace(nodes={"points": node})})
    return Shot(groups, (), "map")


def test_the_newest_comes_first() -> None:
    past = Past(lambda: 0.0)
    shots = [shot() for _ in range(3)]
    for each in shots:
        past.keep("a", each)
    past.keep("b", shot())
    assert [id(each) for each in past.of("a")] == [id(each) for each in reversed(shots)]


def test_the_oldest_go_when_there_are_too_many_bytes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scene_diff, "MAX_BYTES", 15 * 250)
    past = Past(lambda: 0.0)
    shots = [shot(100) for _ in range(5)]
    for number, each in enumerate(shots):
        past.keep("a", each)
        assert len(list(past.of("a"))) == min(number + 1, 2)
    assert [id(each) for each in past.of("a")] == [id(shots[4]), id(shots[3])]
    past.keep("a", shot(1000))
    assert list(past.of("a")) == []
    past.keep("a", shot())  # the bytes of what is gone count no more
    assert len(list(past.of("a"))) == 1


def test_the_oldest_go_when_there_are_too_many() -> None:
    past = Past(lambda: 0.0)
    shots = [shot() for _ in range(MAX_SHOTS + 1)]
    for each in shots:
        past.keep("a", each)
    assert [id(each) for each in past.of("a")] == [id(each) for each in reversed(shots[1:])]


def test_what_is_older_than_some_seconds_is_gone() -> None:
    now = 1000.0
    past = Past(lambda: now)
    past.keep("a", shot())
    now = 1000.0 + KEPT_S - 0.1
    assert len(list(past.of("a"))) == 1
    now = 1000.0 + KEPT_S + 0.1
    assert list(past.of("a")) == []
