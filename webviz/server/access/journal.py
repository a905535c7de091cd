"""Journal of people's actions, for the viewer's owner and for the log."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from datetime import UTC, datetime

import msgspec

from webviz.server.access.visitors import Visitor

log = logging.getLogger("webviz.journal")

MAX_ENTRIES = 200
MAX_TEXT = 200
"""Characters of an entry; it may quote the name of a file or topic."""


class JournalEntry(msgspec.Struct, frozen=True):
    """Something that was done.

    Args:
        time_s: in seconds since 1970.
        name, role, address: of who did it, see `Visitor`; "" if they are gone.
        text: what was done.
    """

    time_s: float
    name: str
    role: str
    address: str
    text: str


class Journal:
    """The newest entries; from any thread.

    Args:
        keep: also called with the line of each entry, such as `JournalFile.write`.
    """

    def __init__(self, keep: Callable[[str], object] | None = None) -> None:
        self._keep = keep
        self._lock = threading.Lock()
        self._entries: tuple[JournalEntry, ...] = ()
        self._newest: deque[JournalEntry] = deque(maxlen=MAX_ENTRIES)

    @property
    def entries(self) -> tuple[JournalEntry, ...]:
        """The newest first; the same object until there is another."""
        return self._entries

    def note(self, visitor: Visitor | None, text: str) -> None:
        """Add a person's action, and log it in one line."""
        name, role, address = "", "", ""
        if visitor is not None:
            name, role, address = visitor.name, visitor.role.label, visitor.address
        # Names of files may contain what terminals obey.
        plain = "".join(c if c.isprintable() else "?" for c in text)[:MAX_TEXT]
        entry = JournalEntry(time.time(), name, role, address, plain)
        with self._lock:
            self._newest.appendleft(entry)
            self._entries = tuple(self._newest)
        who = ", ".join(filter(None, (role, address))) or "a page that is gone"
        line = f"{name} ({who}): {plain}".lstrip()
        log.info("%s", line)
        if self._keep is not None:
            at = datetime.fromtimestamp(entry.time_s, UTC).isoformat(timespec="seconds")
            self._keep(f"{at} {line}")
