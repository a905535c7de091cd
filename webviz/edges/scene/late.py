"""Slow work for the scene beside the frame loop: pictures that are encoded."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")

log = logging.getLogger("webviz")


class Late:
    """One thread that makes what is then sent; of each name only the newest.

    What waits is bounded by the number of names, for newer work takes the place of older.
    """

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="webviz-scene")
        self._jobs: dict[str, Future[None]] = {}
        self._changed = threading.Condition()

    def put(self, name: str, make: Callable[[], T], send: Callable[[T], None]) -> None:
        """Calls `send(make())` in the thread, unless the name is put again or dropped before then.

        Args:
            name: of the node whose work it is.
            make: slow; touches nothing that the frame loop changes.
            send: quick; never runs again once `drop` returned.
        """

        def run() -> None:
            try:
                made = make()
                with self._changed:
                    if self._jobs.get(name) is job:
                        send(made)
            except Exception:
                log.exception("%s could not be drawn", name)
            with self._changed:
                if self._jobs.get(name) is job:
                    del self._jobs[name]
                    self._changed.notify_all()

        with self._changed:
            if name in self._jobs:
                self._jobs[name].cancel()
            job = self._jobs[name] = self._pool.submit(run)

    def drop(self, name: str) -> None:
        """Forgets the work of a node and of all below it."""
        with self._changed:
            for each in tuple(self._jobs):
                if each == name or each.startswith(f"{name}/"):
                    self._jobs.pop(each).cancel()
            self._changed.notify_all()

    def wait(self, timeout: float) -> bool:
        """Waits until nothing is left to do; whether that came about within `timeout` seconds."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._jobs, timeout)
