"""Removes shared memory of Fast DDS whose process was killed."""

from __future__ import annotations

import contextlib
import fcntl
import os
import re
import time
from pathlib import Path

FOLDER = Path("/dev/shm")
LOCK = re.compile(r"(fastrtps_[0-9a-f]{16})_el")
MIN_AGE_S = 60.0
"""Younger lock files are ignored, since Fast DDS locks them shortly after their creation."""


def remove_abandoned() -> None:
    """Remove the segments of this user's processes that no longer exist.

    Fast DDS removes its segments on a normal exit only. As long as a process lives, it holds a lock
    on the lock file of its segment.
    """
    with contextlib.suppress(OSError):
        for name in os.listdir(FOLDER):
            if match := LOCK.fullmatch(name):
                with contextlib.suppress(OSError):  # locked, or removed meanwhile
                    _remove(FOLDER / match[1], FOLDER / name)


def _remove(segment: Path, lock: Path) -> None:
    file = os.open(lock, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        status = os.fstat(file)
        if status.st_uid == os.geteuid() and time.time() - status.st_mtime > MIN_AGE_S:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            segment.unlink(missing_ok=True)
            lock.unlink()
    finally:
        os.close(file)
