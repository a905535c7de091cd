"""A journal on the disk, which only its owner can read."""

from __future__ import annotations

import contextlib
import logging
import os
import queue
import stat
import threading
from pathlib import Path

from webviz.api.errors import Error

log = logging.getLogger("webviz")

MAX_BYTES = 1 << 20
"""Limit in bytes of the file, and of the one before, which is kept with the suffix .1."""
MAX_WAITING = 1000
"""Lines that wait for a disk that does not respond; further ones are dropped and counted."""
ENDING_S = 0.5
FLAGS = os.O_WRONLY | os.O_CREAT | os.O_APPEND | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC


class JournalFile:
    """Appends lines to a file, in a thread of its own.

    Args:
        path: of the file; its folder has to exist.

    Raises:
        Error: it cannot be written, or is not a file of this user that others cannot read.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._dropped = 0
        self._lines: queue.Queue[str | None] = queue.Queue(MAX_WAITING)
        try:
            os.close(self._open())
        except OSError as error:
            raise Error(f"Cannot write the journal {path}: {error.strerror}.") from error
        self._thread = threading.Thread(target=self._run, name="webviz-journal", daemon=True)
        self._thread.start()

    def write(self, line: str) -> None:
        """Append a line, without waiting; from any thread."""
        try:
            self._lines.put_nowait(line)
        except queue.Full:
            self._dropped += 1

    def close(self) -> None:
        """Write what waits, if the disk responds in time."""
        with contextlib.suppress(queue.Full):
            self._lines.put(None, timeout=ENDING_S)
        self._thread.join(ENDING_S)

    def _run(self) -> None:
        while (line := self._lines.get()) is not None:
            dropped, self._dropped = self._dropped, 0
            lines = [f"({dropped} entries dropped)"] * (dropped > 0) + [line]
            try:
                self._append("".join(f"{each}\n" for each in lines).encode())
            except (OSError, Error) as error:
                log.warning("An entry is missing in the journal %s: %s", self._path, error)

    def _append(self, data: bytes) -> None:
        with open(self._open(), "ab", buffering=0) as file:
            if os.fstat(file.fileno()).st_size + len(data) <= MAX_BYTES:
                file.write(data)
                return
        os.replace(self._path, self._path.with_name(f"{self._path.name}.1"))
        with open(self._open(), "ab", buffering=0) as file:
            file.write(data)

    def _open(self) -> int:
        """Open the file, which is made if there is none."""
        descriptor = os.open(self._path, FLAGS, 0o600)
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode) or status.st_uid != os.geteuid():
            os.close(descriptor)
            raise Error(f"{self._path} is not a file of this user. Choose another journal.")
        os.fchmod(descriptor, 0o600)
        return descriptor
