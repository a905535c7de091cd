"""Tuning of glibc's heap for large messages."""

from __future__ import annotations

import ctypes
import os
import time
from collections.abc import Callable
from pathlib import Path

PERIOD_S = 10.0
LOOK_S = 0.5
LARGE = 1 << 20
"""Message size in bytes above which reusing freed memory is cheaper than fresh pages."""
MAX_UNUSED = 192 << 20
"""Bytes of freed memory that are kept. To return so many takes 14 ms."""

_LIBC = ctypes.CDLL(None)
_PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")


class Heap:
    """Keeps freed memory while large messages arrive, and returns it to the system afterwards.

    Freed buffers of up to 32 MB stay in one heap for all threads. By default a 16 MB message costs
    30 ms of page faults (measured: 40 ms of CPU instead of 12.5 ms), because it is received, drawn
    and sent in three threads with separate heaps. One heap also saves two thirds of the page faults
    of a busy /tf (measured: 330 per second).

    When large messages stop, or become much smaller, free pages are returned. After twelve clouds
    of 24 MB, 31 MB remain instead of 169 MB; DDS holds 24 MB of them until the subscription ends.
    With nothing to return this takes 2 ms.

    While large messages of different sizes arrive, the free memory between others fits none of
    them, and grows (measured: 1300 MB beside 800 MB in use). Hence more than `MAX_UNUSED` is
    returned at once. Without glibc nothing happens.

    Args:
        clock: monotonic time in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._next = clock() + PERIOD_S
        self._next_look = clock() + LOOK_S
        self._least_unused = 0
        self._largest = self._before = 0
        mmap_threshold, trim_threshold, arena_max = -3, -1, -8  # M_MMAP_THRESHOLD etc. in malloc.h
        if hasattr(_LIBC, "mallopt"):
            _LIBC.mallopt(mmap_threshold, 32 << 20)
            _LIBC.mallopt(trim_threshold, 512 << 20)
            _LIBC.mallopt(arena_max, 1)

    def note(self, size: int) -> None:
        """Record the size of a message in bytes."""
        self._largest = max(self._largest, size)

    def turn(self) -> None:
        """Return memory that is no longer needed; to be called several times a second."""
        now = self._clock()
        if now >= self._next_look and max(self._largest, self._before) >= LARGE:
            self._next_look = now + LOOK_S
            self._look()
        if now < self._next:
            return
        self._next = now + PERIOD_S
        is_needed = self._largest >= max(LARGE, self._before / 2)
        self._before, self._largest = self._largest, 0
        if not is_needed:
            _trim()

    def _look(self) -> None:
        """Return free memory if there is much more than cannot be returned."""
        unused = _unused()
        if unused > self._least_unused + MAX_UNUSED:
            _trim()
            unused = self._least_unused = _unused()
        self._least_unused = min(self._least_unused, unused)


class _Usage(ctypes.Structure):
    """Result of glibc's `mallinfo2`, in bytes."""

    _fields_ = tuple(
        (name, ctypes.c_size_t)
        for name in (
            *("arena", "ordblks", "smblks", "hblks", "hblkhd"),
            *("usmblks", "fsmblks", "uordblks", "fordblks", "keepcost"),
        )
    )
    hblkhd: int
    uordblks: int


if hasattr(_LIBC, "mallinfo2"):
    _LIBC.mallinfo2.restype = _Usage


def _unused() -> int:
    """Bytes of private memory that the heap has not given out; 0 if that is unknown.

    What `mallinfo2` calls free counts also if it was returned to the system, so it is not asked.
    """
    if not hasattr(_LIBC, "mallinfo2"):
        return 0
    usage: _Usage = _LIBC.mallinfo2()
    _, resident, shared, *_ = map(int, Path("/proc/self/statm").read_text().split())
    return (resident - shared) * _PAGE_BYTES - usage.uordblks - usage.hblkhd


def _trim() -> None:
    if hasattr(_LIBC, "malloc_trim"):
        _LIBC.malloc_trim(0)
