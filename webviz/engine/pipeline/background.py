"""Slow work in threads."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

from webviz.api.display import Display


def is_slow(display: Display, size: int) -> bool:
    """Return whether messages of `size` bytes are folded and drawn in a worker."""
    return display.is_threaded and size >= display.slow_bytes


class Workers:
    """Threads for the slow work of all displays.

    Args:
        wake: called from a worker whenever a result is ready.
    """

    def __init__(self, wake: Callable[[], None]) -> None:
        self._pool = ThreadPoolExecutor(max_workers=4, thread_name_prefix="webviz-worker")
        self.wake = wake
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
        """End work that is no longer needed as soon as possible."""
        if not future.cancel() and (stop := self._stops.get(future)):
            stop()

    def close(self) -> None:
        """Cancel or stop all work, and wait until it has ended."""
        for future in tuple(self._stops):
            self.cancel(future)
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _on_done(self, future: Future[Any]) -> None:
        self._stops.pop(future, None)
        self.wake()


class Tasks:
    """The slow work of one display: `ctx.background`.

    Work that a display no longer requests is cancelled, so a stale result is never drawn.
    """

    def __init__(self, workers: Workers) -> None:
        self._workers = workers
        self._futures: dict[object, Future[Any]] = {}
        self._requested: set[object] = set()
        self._pending: set[object] = set()

    def __call__(
        self,
        key: object,
        fn: Callable[..., Any],
        *args: Any,
        stop: Callable[[], None] | None = None,
    ) -> Any:
        """Return the result of `fn(*args)`, None until it is ready.

        The same for all calls of a drawing.

        Args:
            key: identifies the work and its arguments.
            fn: runs in a thread; must not touch the state of the frame loop.
            args: for `fn`.
            stop: makes `fn` end early; called from any thread once the result is not needed.

        Raises:
            Exception: raised by `fn`.
        """
        # Who asked first in a drawing must not miss what became ready before the next one asks, nor
        # what was drawn before the request miss work that is done at once.
        has_to_wait = key not in self._futures or key in self._requested & self._pending
        self._requested.add(key)
        if key not in self._futures:
            self._futures[key] = self._workers.submit(fn, *args, stop=stop)
        future = self._futures[key]
        if has_to_wait or not future.done():
            self._pending.add(key)
            return None
        self._pending.discard(key)
        return future.result()

    def has_news(self) -> bool:
        """Return whether a result is ready that was not when it was requested."""
        return any(self._futures[key].done() for key in self._pending)

    def is_busy(self) -> bool:
        """Return whether a requested result is not drawn yet."""
        return bool(self._pending)

    def cancel_unrequested(self) -> None:
        """Cancel work that was not requested since the last call."""
        for key in self._futures.keys() - self._requested:
            self._workers.cancel(self._futures.pop(key))
            self._pending.discard(key)
        self._requested.clear()

    def close(self) -> None:
        """Cancel everything."""
        self._requested.clear()
        self.cancel_unrequested()
