"""Slow work beside the frame loop."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any


class Workers:
    """A few threads for the slow work of all displays.

    Args:
        wake: called from a worker whenever a result is there.
    """

    def __init__(self, wake: Callable[[], None]) -> None:
        self._pool = ThreadPoolExecutor(max_workers=2, thread_name_prefix="webviz-worker")
        self._wake = wake
        self._stops: dict[Future[Any], Callable[[], None]] = {}

    def submit(
        self, fn: Callable[..., Any], *args: Any, stop: Callable[[], None] | None = None
    ) -> Future[Any]:
        """Start work; the frame loop wakes when it is done.

        Args:
            fn: the work.
            args: for `fn`.
            stop: makes `fn` end early; None if it is short.
        """
        future = self._pool.submit(fn, *args)
        if stop is not None:
            self._stops[future] = stop
        future.add_done_callback(self._on_done)
        return future

    def cancel(self, future: Future[Any]) -> None:
        """Make work that is not wanted any more end as soon as it can."""
        if not future.cancel() and (stop := self._stops.get(future)):
            stop()

    def close(self) -> None:
        """Forget what has not begun, stop what can be stopped and wait for the rest."""
        for future in tuple(self._stops):
            self.cancel(future)
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _on_done(self, future: Future[Any]) -> None:
        self._stops.pop(future, None)
        self._wake()


class Tasks:
    """The slow work of one display: `ctx.background`.

    Work that a display no longer asks for is forgotten, so a stale result is never drawn.
    """

    def __init__(self, workers: Workers) -> None:
        self._workers = workers
        self._futures: dict[object, Future[Any]] = {}
        self._asked: set[object] = set()
        self._unanswered: set[object] = set()

    def __call__(
        self,
        key: object,
        fn: Callable[..., Any],
        *args: Any,
        stop: Callable[[], None] | None = None,
    ) -> Any:
        """The result of `fn(*args)`, None while it is not there.

        Args:
            key: names the work and what goes into it; another key is other work.
            fn: runs in a thread; must not touch anything the frame loop changes.
            args: for `fn`.
            stop: makes `fn` end early; called from any thread once nobody asks for the result.

        Raises:
            Exception: what `fn` raised.
        """
        self._asked.add(key)
        if key not in self._futures:
            self._futures[key] = self._workers.submit(fn, *args, stop=stop)
        future = self._futures[key]
        if not future.done():
            self._unanswered.add(key)
            return None
        self._unanswered.discard(key)
        return future.result()

    def has_news(self) -> bool:
        """Whether work is done that was asked for in vain before."""
        return any(self._futures[key].done() for key in self._unanswered)

    def is_busy(self) -> bool:
        """Whether a result that was asked for has not been drawn yet."""
        return bool(self._unanswered)

    def forget_unasked(self) -> None:
        """Drop what was not asked for since the last call."""
        for key in self._futures.keys() - self._asked:
            self._workers.cancel(self._futures.pop(key))
            self._unanswered.discard(key)
        self._asked.clear()

    def close(self) -> None:
        """Drop everything."""
        self._asked.clear()
        self.forget_unasked()
