"""Processes and threads that tests start, of which each may end at any moment."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress

import psutil

PATIENCE_S = 60.0


def command_lines(pid: int | None = None) -> dict[psutil.Process, str]:
    """The living processes that a process has started, with their command lines.

    Args:
        pid: of the process; None is this one.
    """
    result = {}
    for process in psutil.Process(pid).children(recursive=True):
        with suppress(psutil.NoSuchProcess):  # also of one that only waits to be reaped
            result[process] = " ".join(process.cmdline())
    return result


def send(number: int, processes: Iterable[psutil.Process]) -> None:
    """Send a signal to those that still live."""
    for process in processes:
        with suppress(psutil.NoSuchProcess):
            process.send_signal(number)


@contextmanager
def no_thread_left() -> Iterator[None]:
    """Fails if a thread that was started in the block does not end; older ones may end in it."""
    before = set(threading.enumerate())
    yield
    for thread in set(threading.enumerate()) - before:
        thread.join(PATIENCE_S)  # a viewer does not wait for what takes long on a busy machine
        assert not thread.is_alive(), thread
