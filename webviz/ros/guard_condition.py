"""The wake-up of an executor, from any thread."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any


class GuardCondition:
    """The part of a future that executors wait for; unlike a future, it is triggered repeatedly.

    rclpy's events executor is not ended by its `wake`, but by a future.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._is_triggered = False
        self._end: Callable[[Any], object] | None = None

    def trigger(self) -> None:
        """End the current wait, or else the next one; from any thread."""
        with self._lock:
            self._is_triggered = True
            end = self._end
        if end is not None:
            end(self)

    def reset(self) -> None:
        """Begin anew, before looking for what it was triggered for."""
        with self._lock:
            self._is_triggered = False
            self._end = None

    # For executors

    def done(self) -> bool:
        """Return whether it was triggered."""
        return self._is_triggered

    def cancelled(self) -> bool:
        """Return that it was not: the default executor of Jazzy and later asks."""
        return False

    def add_done_callback(self, callback: Callable[[Any], object]) -> None:
        """Have this called when it is triggered, at once if it already is."""
        with self._lock:
            self._end = callback
            is_triggered = self._is_triggered
        if is_triggered:
            callback(self)

    def remove_done_callback(self, callback: Callable[[Any], object]) -> None:
        """Have it called no more."""
        with self._lock:
            self._end = None
