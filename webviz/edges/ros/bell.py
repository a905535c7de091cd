"""Ends the wait of an executor, from any thread."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any


class Bell:
    """The part of a future that executors need to wait for it; unlike a future, it rings again.

    rclpy's events executor is not ended by its `wake`, but by a future.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._has_rung = False
        self._end: Callable[[Any], object] | None = None

    def ring(self) -> None:
        """End the current wait, or else the next one; from any thread."""
        with self._lock:
            self._has_rung = True
            end = self._end
        if end is not None:
            end(self)

    def reset(self) -> None:
        """Begin anew, before looking for what it was rung for."""
        with self._lock:
            self._has_rung = False
            self._end = None

    # For executors

    def done(self) -> bool:
        """Return whether it has rung."""
        return self._has_rung

    def add_done_callback(self, callback: Callable[[Any], object]) -> None:
        """Have this called when it rings, at once if it has rung."""
        with self._lock:
            self._end = callback
            has_rung = self._has_rung
        if has_rung:
            callback(self)

    def remove_done_callback(self, callback: Callable[[Any], object]) -> None:
        """Have it called no more."""
        with self._lock:
            self._end = None
