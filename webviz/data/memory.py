"""One budget for the memory that decoding takes, shared by all threads."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator


class OverBudgetError(ValueError):
    """Something would take more than the whole budget; the text is a clause that says how much."""


class MemoryBudget:
    """Memory that threads take before they allocate it, by what a header claims.

    Args:
        total: in bytes.
    """

    def __init__(self, total: int) -> None:
        self.total = total
        self._free = total
        self._changed = threading.Condition()
        self._mine = threading.local()

    @contextlib.contextmanager
    def take(self, size: int) -> Iterator[None]:
        """Hold `size` bytes, after waiting until so many are free.

        A thread that holds some already does not wait for more, or two could wait for each other.

        Raises:
            OverBudgetError: it is more than the total.
        """
        if size > self.total:
            needed, limit = f"{size / 1e6:.0f} MB", f"{self.total / 1e6:.0f} MB"
            raise OverBudgetError(f"takes {needed} to decode; the limit is {limit}")
        held: int = getattr(self._mine, "held", 0)
        with self._changed:
            if not held:
                self._changed.wait_for(lambda: self._free >= size)
            self._free -= size
        self._mine.held = held + size
        try:
            yield
        finally:
            self._mine.held = held
            with self._changed:
                self._free += size
                self._changed.notify_all()


DECODING = MemoryBudget(640_000_000)
"""Of all images; a browser's largest JPEG, of 8192 x 8192 pixels, takes 540 MB."""
