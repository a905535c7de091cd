"""Slow work beside the frame loop."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from webviz.api.nodes import Image
from webviz.scene import ViserScene
from webviz.scene.deferred import DeferredMessages


def test_only_the_newest_work_of_a_name_is_sent() -> None:
    late, begun, go, results = DeferredMessages(), threading.Event(), threading.Event(), list[int]()

    def slow() -> int:
        begun.set()
        go.wait(60)
        return 1

    late.put("/map", slow, results.append)
    assert begun.wait(60)
    late.put("/map", lambda: 2, results.append)
    late.put("/map", lambda: 3, results.append)
    assert not late.wait(0.0)
    go.set()
    late.finish(10)
    assert results == [3]


def test_dropped_work_and_work_below_it_is_never_sent() -> None:
    late, begun, go, results = DeferredMessages(), threading.Event(), threading.Event(), list[str]()

    def slow() -> str:
        begun.set()
        go.wait(60)
        return "running"

    late.put("/map/a", slow, results.append)
    late.put("/map/b", lambda: "waiting", results.append)
    late.put("/map2", lambda: "other", results.append)
    assert begun.wait(60)
    late.drop("/map")
    go.set()
    late.finish(10)
    assert results == ["other"]


def test_work_that_fails_is_logged_and_does_not_stop_the_rest(
    caplog: pytest.LogCaptureFixture,
) -> None:
    late, results = DeferredMessages(), list[int]()
    late.put("/bad", lambda: 1 // 0, results.append)
    late.put("/good", lambda: 1, results.append)
    late.finish(10)
    assert results == [1]
    assert "/bad could not be drawn" in caplog.text


def test_a_picture_that_is_removed_while_it_is_encoded_leaves_nothing(
    scene: ViserScene, call: Callable[..., Any]
) -> None:
    go = threading.Event()
    scene.link.deferred.put("/before", lambda: go.wait(60), lambda _: None)
    scene.upsert("map", "it", Image(np.zeros((3, 4, 4), np.uint8), 4.0, 3.0))
    scene.flush()
    scene.remove_group("map")
    scene.flush()
    go.set()
    scene.link.deferred.finish(10)
    assert not [m for m in call().replay() if m["type"] == "ImageMessage"]
