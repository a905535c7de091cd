"""Removal of shared memory of Fast DDS whose process was killed."""

from __future__ import annotations

import contextlib
import fcntl
import math
import os
import re
import time
from collections.abc import Iterable
from pathlib import Path

FOLDER = Path("/dev/shm")
LOCK = re.compile(r"(fast(?:rtps|dds)_[0-9a-f]{16})_el")
SEGMENT = re.compile(rf"{FOLDER}/fast(?:rtps|dds)_[0-9a-f]{{16}}\b")
"""Fast DDS 3, of Kilted, has other names than 2, of Jazzy."""
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
                    _remove(FOLDER / match[1], MIN_AGE_S)


def segments_of(process: int) -> set[Path]:
    """Return the segments that a process uses, its own and those of others that it talks to.

    Args:
        process: its id.
    """
    with contextlib.suppress(OSError):  # it has ended
        return {Path(name) for name in SEGMENT.findall(Path(f"/proc/{process}/maps").read_text())}
    return set()


def remove_unused(segments: Iterable[Path]) -> None:
    """Remove the segments whose process was killed, such as those that it used."""
    for segment in segments:
        with contextlib.suppress(OSError):
            _remove(segment, -math.inf)


def _remove(segment: Path, min_age_s: float) -> None:
    lock = segment.with_name(f"{segment.name}_el")
    file = os.open(lock, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        status = os.fstat(file)
        if status.st_uid == os.geteuid() and time.time() - status.st_mtime > min_age_s:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            segment.unlink(missing_ok=True)
            lock.unlink()
    finally:
        os.close(file)
