"""Slow work beside the frame loop."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np

from webviz.api.nodes import Image
from webviz.scene import ViserScene
from webviz.scene.deferred import DeferredMessages


def test_of_one_name_only_the_newest_work_is_sent() -> None:
    late, begun, go, sent = DeferredMessages(), threading.Event(), threading.Event(), list[int]()

    def slow() -> int:
        begun.set()
        go.wait(60)
        return 1

    late.put("/map", slow, sent.append)
    assert begun.wait(60)
    late.put("/map", lambda: 2, sent.append)
    late.put("/map", lambda: 3, sent.append)
    assert not late.wait(0.0)
    go.set()
    late.finish(10)
    assert sent == [3]


def test_dropped_work_is_never_sent_nor_that_of_what_lies_below() -> None:
    late, begun, go, sent = DeferredMessages(), threading.Event(), threading.Event(), list[str]()

    def slow() -> str:
        begun.set()
        go.wait(60)
        return "running"

    late.put("/map/a", slow, sent.append)
    late.put("/map/b", lambda: "waiting", sent.append)
    late.put("/map2", lambda: "other", sent.append)
    assert begun.wait(60)
    late.drop("/map")
    go.set()
    late.finish(10)
    assert sent == ["other"]


def test_work_that_fails_is_logged_and_does_not_stop_the_rest(caplog: Any) -> None:
    late, sent = DeferredMessages(), list[int]()
    late.put("/bad", lambda: 1 // 0, sent.append)
    late.put("/good", lambda: 1, sent.append)
    late.finish(10)
    assert sent == [1]
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
