"""Bytes that displays cost on the links to browsers."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Final


class Costs:
    """Counts bytes by browser and display; thread-safe."""

    def __init__(self) -> None:
        self._lock: Final = threading.Lock()
        self._bytes: dict[int, dict[str, int]] = {}

    def add(self, browser: int, sizes: Mapping[str, int]) -> None:
        """Add bytes sent to a browser, by id of the display."""
        with self._lock:
            of_browser = self._bytes.setdefault(browser, {})
            for display, size in sizes.items():
                of_browser[display] = of_browser.get(display, 0) + size

    def by_browser(self) -> Mapping[int, Mapping[str, int]]:
        """Return the bytes so far, by id of the browser and of the display."""
        with self._lock:
            return {browser: dict(sizes) for browser, sizes in self._bytes.items()}
