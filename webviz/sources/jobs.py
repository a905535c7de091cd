"""Functions that other threads hand to the thread of a connection."""

from __future__ import annotations

import queue
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

from webviz.sources.graph import NotConnected

T = TypeVar("T")

MAX_JOBS = 1000


class Jobs:
    """A bounded queue of functions.

    Args:
        wake: makes the thread call `run` soon.
        ended: why nothing more is done after `end`; a sentence.
    """

    def __init__(self, wake: Callable[[], None], ended: str) -> None:
        self._wake = wake
        self._ended = ended
        self._queue: queue.Queue[tuple[Callable[[], object], Future]] = queue.Queue(MAX_JOBS)
        self._has_ended = False

    def put(self, do: Callable[[], T]) -> Future[T]:
        """Queue `do`; the future receives what it returns or raises."""
        future: Future[T] = Future()
        try:
            self._queue.put_nowait((do, future))
        except queue.Full:
            future.set_exception(NotConnected("Too many requests at once. Try again later."))
        if self._has_ended:
            self.end()
        self._wake()
        return future

    def run(self) -> None:
        """Call the queued functions."""
        for _ in range(self._queue.qsize()):
            do, future = self._queue.get_nowait()
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(do())
            except Exception as error:
                future.set_exception(error)

    def end(self) -> None:
        """Fail the queued functions and all later ones."""
        self._has_ended = True
        while True:
            try:
                _, future = self._queue.get_nowait()
            except queue.Empty:
                return
            future.set_exception(NotConnected(self._ended))
