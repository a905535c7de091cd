"""One budget for the memory of decoded data, shared by all threads."""

from __future__ import annotations

import contextlib
import threading
import weakref
from collections.abc import Iterator


class OverBudgetError(ValueError):
    """Something would take more than there is; the text is a clause that says how much."""


class MemoryBudget:
    """Memory that threads take before they allocate it, by what a header claims.

    Work waits for memory that other work gives back. What is loaded keeps its share until it is
    gone; it may have a part of the total, so that there is always room to work in.

    Args:
        total: in bytes.
        loaded: of it, the bytes that what is loaded may have; half of it by default.
    """

    def __init__(self, total: int, loaded: int | None = None) -> None:
        self.total = total
        self._most_held = total // 2 if loaded is None else loaded
        self._decode_size = self._loaded_size = 0
        self._changed = threading.Condition()
        self._mine = threading.local()

    @property
    def room(self) -> int:
        """Bytes that work may take if there is no other."""
        return self.total - self._loaded_size

    @property
    def least_room(self) -> int:
        """Bytes that work gets sooner or later, however much is loaded."""
        return self.total - self._most_held

    @property
    def is_scarce(self) -> bool:
        """Return whether little is left for what is loaded, so that caches should be emptied."""
        return self._loaded_size > self._most_held // 2

    @contextlib.contextmanager
    def take(self, size: int, stopped: threading.Event | None = None) -> Iterator[None]:
        """Hold `size` bytes for work, after waiting until so many are free.

        A thread that holds some already does not wait for more, or two could wait for each other.

        Args:
            size: in bytes.
            stopped: ends waiting once it is set and `wake` called; the work checks it.

        Raises:
            OverBudgetError: there is not so much even without other work.
        """
        reserved: int = getattr(self._mine, "reserved", 0)
        with self._changed:
            while not (stopped and stopped.is_set()):
                if size > self.room:
                    text = f"takes {_mb(size)} to decode; the limit is {_mb(self.room)}"
                    beside = (
                        f" beside {_mb(self._loaded_size)} already loaded"
                        if self._loaded_size
                        else ""
                    )
                    raise OverBudgetError(text + beside)
                if reserved or self._decode_size + size <= self.room:
                    break
                self._changed.wait()
            self._decode_size += size
        self._mine.reserved = reserved + size
        try:
            yield
        finally:
            self._mine.reserved = reserved
            with self._changed:
                self._decode_size -= size
                self._changed.notify_all()

    def hold(self, owner: object, size: int) -> None:
        """Hold `size` bytes until `owner` is garbage.

        Raises:
            OverBudgetError: too much is held already.
        """
        with self._changed:
            left = self._most_held - self._loaded_size
            if size > left:
                limit = _mb(self._most_held)
                raise OverBudgetError(
                    f"takes {_mb(size)} of memory; {_mb(left)} of {limit} are left"
                )
            self._loaded_size += size
        weakref.finalize(owner, self._give_back, size).atexit = False

    def wake(self) -> None:
        """Let work that was stopped end waiting."""
        with self._changed:
            self._changed.notify_all()

    def _give_back(self, size: int) -> None:
        with self._changed:
            self._loaded_size -= size
            self._changed.notify_all()


def _mb(size: int) -> str:
    return f"{size / 1e6:.0f} MB"


DECODING = MemoryBudget(1_000_000_000, 450_000_000)
"""Memory for images, meshes, pictures and octrees. Besides, a viewer takes 450 MB with a simulated
robot. A browser's largest JPEG, of 8192 x 8192 pixels, takes 540 MB."""
