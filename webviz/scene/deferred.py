"""Slow messages, such as encoded images, made outside of the frame loop."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")

log = logging.getLogger("webviz")


class DeferredMessages:
    """A thread that makes messages, which the frame loop then sends.

    The queue is bounded by the number of names, since newer work replaces older work of the same
    name. All methods but `wait` belong to the frame loop.
    """

    def __init__(self) -> None:
        self.wake: Callable[[], None] = lambda: None
        """Called in any thread when there is something to send."""
        self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="webviz-scene")
        self._jobs: dict[str, Future[None]] = {}
        self._callbacks: dict[str, Callable[[], None]] = {}
        self._changed = threading.Condition()

    def put(self, name: str, make: Callable[[], T], send: Callable[[T], None]) -> None:
        """Call `make` in the thread, and `send` with its result in the next `deliver`.

        Work that has not started, or was not sent, is dropped when the name is put again.

        Args:
            name: of the node.
            make: slow; must not use anything that the frame loop changes.
            send: quick.
        """

        def run() -> None:
            try:
                message = make()
            except Exception:
                log.exception("%s could not be drawn", name)
                with self._changed:
                    if self._jobs.get(name) is job:
                        self._forget(name)
                return
            with self._changed:
                if self._jobs.get(name) is job:
                    self._callbacks[name] = lambda: send(message)
                    self._changed.notify_all()
            self.wake()

        with self._changed:
            self._callbacks.pop(name, None)
            if name in self._jobs:
                self._jobs[name].cancel()
            job = self._jobs[name] = self._pool.submit(run)

    def drop(self, name: str) -> None:
        """Cancel the work of a node and of all below it."""
        with self._changed:
            for each in tuple(self._jobs):
                if each == name or each.startswith(f"{name}/"):
                    self._jobs[each].cancel()
                    self._forget(each)

    def deliver(self) -> None:
        """Send the messages that are ready."""
        with self._changed:
            messages = dict(self._callbacks)
        for name, send in messages.items():
            try:
                send()
            except Exception:
                log.exception("%s could not be drawn", name)
            with self._changed:
                self._forget(name)

    def finish(self, timeout: float) -> None:
        """Wait for all work, and send the messages.

        Raises:
            TimeoutError: it takes longer than `timeout` seconds.
        """
        with self._changed:
            is_made = self._changed.wait_for(
                lambda: self._callbacks.keys() == self._jobs.keys(), timeout
            )
        if not is_made:
            raise TimeoutError(f"Pictures were not encoded within {timeout:g} s.")
        self.deliver()

    def wait(self, timeout: float) -> bool:
        """Wait until all was sent; return whether this took less than `timeout` seconds."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._jobs, timeout)

    def _forget(self, name: str) -> None:
        self._jobs.pop(name, None)
        self._callbacks.pop(name, None)
        self._changed.notify_all()
