"""Waiting for the disk with a time limit: a dead network mount never answers."""

from __future__ import annotations

import errno
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

MAX_THREADS = 16
"""At once; a thread that waits for a dead mount cannot be ended."""

T = TypeVar("T")

_free = threading.BoundedSemaphore(MAX_THREADS)


def in_thread(work: Callable[[], T]) -> Future[T]:
    """Start work in a thread of its own, which does not keep the program from ending.

    Raises:
        OSError: too many such threads still wait for a disk.
    """
    if not _free.acquire(blocking=False):
        raise OSError(errno.EAGAIN, "too many files do not respond")
    done: Future[T] = Future()

    def run() -> None:
        try:
            try:
                result = work()
            finally:
                _free.release()
        except BaseException as error:
            done.set_exception(error)
        else:
            done.set_result(result)

    threading.Thread(target=run, name="webviz-disk", daemon=True).start()
    return done


def within(seconds: float, work: Callable[[], T]) -> T:
    """The result of work on a disk.

    Raises:
        OSError: the time is over; the work continues in its thread.
        Exception: what the work raises.
    """
    done = in_thread(work)
    try:
        return done.result(seconds)
    except TimeoutError as error:
        if done.done():
            raise
        raise TimeoutError(errno.ETIMEDOUT, f"no response within {seconds:g} s") from error
