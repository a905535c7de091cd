"""Slow work for the newest message only."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

from webviz import Context

T = TypeVar("T")


class Newest(Generic[T]):
    """Work beside the frame loop, one piece at a time.

    What comes meanwhile waits, or is replaced by something newer: so there are results however fast
    messages come.
    """

    def __init__(self) -> None:
        self._current: tuple[Hashable, Callable[[], T]] | None = None
        self._result: tuple[Hashable, T] | None = None

    def of(self, key: Hashable, run: Callable[[], T], ctx: Context) -> T | None:
        """Return the result of `run`, or until that is ready the newest before it.

        None without one.

        Args:
            key: identifies the work and all that it depends on.
            run: runs in a thread.
            ctx: of the display.

        Raises:
            Exception: raised by `run`.
        """
        if self._result is not None and self._result[0] == key:
            return self._result[1]
        current = self._current or (key, run)
        try:
            result = ctx.background(current[0], current[1])
        except Exception:
            self._current = self._result = None
            raise
        self._current = current
        if result is not None:
            self._result, self._current = (current[0], result), None
            if current[0] != key:
                self._current = key, run
                ctx.background(key, run)
        return self._result[1] if self._result else None
