"""The slow work of a display."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from concurrent.futures import Future, wait
from contextlib import closing
from typing import Any

import pytest

from webviz.engine.pipeline.background import Tasks, Workers


@pytest.fixture
def done() -> threading.Event:
    return threading.Event()


@pytest.fixture
def workers(done: threading.Event) -> Iterator[Workers]:
    workers = Workers(wake=done.set)
    yield workers
    workers.close()


def test_all_calls_of_a_drawing_get_the_same_answer(
    workers: Workers, done: threading.Event
) -> None:
    tasks, may_end = Tasks(workers), threading.Event()

    def load() -> str:
        may_end.wait(60)
        return "mesh"

    assert tasks("mesh", load) is None
    may_end.set()
    assert done.wait(60)
    assert tasks("mesh", load) is None
    tasks.cancel_unrequested()  # the drawing is over
    assert tasks.is_busy()
    assert tasks.has_news()
    assert tasks("mesh", load) == "mesh"
    assert not tasks.is_busy()


class Immediate(Workers):
    """Has done the work when it returns."""

    def submit(self, *args: Any, **options: Any) -> Future[Any]:
        future = super().submit(*args, **options)
        wait([future], 60)
        return future


def test_work_that_is_done_at_once_is_left_to_the_next_drawing() -> None:
    with closing(Immediate(lambda: None)) as workers:
        tasks = Tasks(workers)
        assert tasks("mesh", str.upper, "mesh") is None  # much may have been drawn without it
        assert tasks.is_busy()
        assert tasks.has_news()
        tasks.cancel_unrequested()
        assert tasks("mesh", str.upper, "mesh") == "MESH"
        assert not tasks.is_busy()
