"""Files of robots that only their own machines have, such as meshes behind a bridge.

A source that can fetch files registers its function here; loading robots asks it for what this
machine lacks.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future

Fetch = Callable[[str], Future[bytes]]
"""Fetches the file of a `package://` URI; its future raises `webviz.api.errors.Error`."""

_lock = threading.Lock()
_fetches: list[Fetch] = []


def provide(fetch: Fetch) -> None:
    """Register a function, which is asked before those registered earlier."""
    with _lock:
        _fetches.insert(0, fetch)


def withdraw(fetch: Fetch) -> None:
    """Remove a function."""
    with _lock:
        if fetch in _fetches:
            _fetches.remove(fetch)


def fetches() -> tuple[Fetch, ...]:
    """Return the registered functions."""
    with _lock:
        return tuple(_fetches)
