"""Waiting for the disk with a time limit: a dead network mount never answers."""

from __future__ import annotations

import errno
import queue
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

MAX_THREADS = 16
"""Largest number of threads of `in_thread` at once; a thread that waits for a dead mount cannot be
ended."""

KEPT_S = 10.0
"""Seconds for which a thread waits for more work."""

T = TypeVar("T")


class DiskThreads:
    """Threads that wait for a disk, of which those that never return leave room for no others.

    Hence each purpose has its own: what operators name must not keep the owner from saving. Threads
    are kept for a while: starting one waits until it runs, which takes long on a busy machine.

    Args:
        limit: of threads at once.
    """

    def __init__(self, limit: int) -> None:
        self._free = threading.BoundedSemaphore(limit)
        self._work: queue.SimpleQueue[Callable[[], object]] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._idle = 0
        """Idle threads without a job ahead."""

    def start(self, work: Callable[[], T]) -> Future[T]:
        """Start work in a thread of its own, which does not keep the program from ending.

        Raises:
            OSError: too many such threads still wait for a disk, or the system has none left.
        """
        if not self._free.acquire(blocking=False):
            raise OSError(errno.EAGAIN, "too many files do not respond")
        future: Future[T] = Future()

        def run() -> None:
            try:
                try:
                    result = work()
                finally:
                    self._free.release()
            except BaseException as error:
                future.set_exception(error)
            else:
                future.set_result(result)

        with self._lock:
            is_waited_for = self._idle > 0
            self._idle -= is_waited_for
        try:
            if not is_waited_for:
                threading.Thread(target=self._serve, name="webviz-disk", daemon=True).start()
        except RuntimeError as error:
            self._free.release()
            raise OSError(errno.EAGAIN, "no thread is left for a file") from error
        self._work.put(run)
        return future

    def _serve(self) -> None:
        """Work until there has been nothing to do for a while."""
        while True:
            try:
                run = self._work.get(timeout=KEPT_S)
            except queue.Empty:
                with self._lock:
                    if self._idle > 0:
                        self._idle -= 1
                        return
                continue  # some is on its way
            run()
            del run  # it holds what it was for
            with self._lock:
                self._idle += 1

    def within(self, seconds: float, work: Callable[[], T]) -> T:
        """Return the result of work on a disk.

        Raises:
            OSError: the time is over; the work continues in its thread.
            Exception: what the work raises.
        """
        future = self.start(work)
        try:
            return future.result(seconds)
        except TimeoutError as error:
            if future.done():
                raise
            raise TimeoutError(errno.ETIMEDOUT, f"no response within {seconds:g} s") from error


_config_files = DiskThreads(MAX_THREADS)
in_thread = _config_files.start
within = _config_files.within
