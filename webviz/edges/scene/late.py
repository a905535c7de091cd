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
    """One thread that makes what the frame loop then sends; of each name only the newest.

    What waits is bounded by the number of names, for newer work takes the place of older. All
    methods but `wait` belong to the frame loop.
    """

    def __init__(self) -> None:
        self.wake: Callable[[], None] = lambda: None
        """Called in the thread when there is something to deliver."""
        self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="webviz-scene")
        self._jobs: dict[str, Future[None]] = {}
        self._made: dict[str, Callable[[], None]] = {}
        self._changed = threading.Condition()

    def put(self, name: str, make: Callable[[], T], send: Callable[[T], None]) -> None:
        """Calls `make` in the thread, and `send` with what it made on the next `deliver`.

        Neither is called once the name is put again or dropped, if that is before its turn.

        Args:
            name: of the node whose work it is.
            make: slow; touches nothing that the frame loop changes.
            send: quick.
        """

        def run() -> None:
            try:
                made = make()
            except Exception:
                log.exception("%s could not be drawn", name)
                with self._changed:
                    if self._jobs.get(name) is job:
                        self._forget(name)
                return
            with self._changed:
                if self._jobs.get(name) is job:
                    self._made[name] = lambda: send(made)
                    self._changed.notify_all()
            self.wake()

        with self._changed:
            self._made.pop(name, None)
            if name in self._jobs:
                self._jobs[name].cancel()
            job = self._jobs[name] = self._pool.submit(run)

    def drop(self, name: str) -> None:
        """Forgets the work of a node and of all below it."""
        with self._changed:
            for each in tuple(self._jobs):
                if each == name or each.startswith(f"{name}/"):
                    self._jobs[each].cancel()
                    self._forget(each)

    def deliver(self) -> None:
        """Sends what has been made."""
        with self._changed:
            made = dict(self._made)
        for name, send in made.items():
            try:
                send()
            except Exception:
                log.exception("%s could not be drawn", name)
            with self._changed:
                self._forget(name)

    def finish(self, timeout: float) -> None:
        """Waits for all that is under way, and sends it.

        Raises:
            TimeoutError: that takes longer than `timeout` seconds.
        """
        with self._changed:
            is_made = self._changed.wait_for(
                lambda: self._made.keys() == self._jobs.keys(), timeout
            )
        if not is_made:
            raise TimeoutError(f"Pictures were not encoded within {timeout:g} s.")
        self.deliver()

    def wait(self, timeout: float) -> bool:
        """Waits until all was sent; whether that came about within `timeout` seconds."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._jobs, timeout)

    def _forget(self, name: str) -> None:
        self._jobs.pop(name, None)
        self._made.pop(name, None)
        self._changed.notify_all()
