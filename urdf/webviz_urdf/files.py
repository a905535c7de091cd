"""Reading files that untrusted input may name."""

from __future__ import annotations

import os
import stat
from pathlib import Path

LFS = b"version https://git-lfs.github.com/spec/"
"""The first bytes of a pointer that Git LFS leaves in place of a file."""


def read_file(path: Path, limit: int) -> bytes:
    """Read a regular file; FIFOs, devices and files of the kernel are refused without waiting.

    Args:
        path: of the file.
        limit: bytes.

    Raises:
        OSError: it cannot be read, is not a regular file, is empty, is larger than `limit`, or is a
            pointer of Git LFS; `strerror` says which.
        ValueError: the path has a null byte.
    """
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    with open(descriptor, "rb") as file:
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode):
            raise OSError(0, "it is not a regular file", str(path))
        # Files of /proc, too, some of which never end or lose what is read.
        if not status.st_size:
            raise OSError(0, "it is empty, or not a file of a disk", str(path))
        # No more than there is: as many bytes are allocated as are asked for.
        data = file.read(min(status.st_size, limit) + 1)
    if len(data) > limit:
        raise OSError(0, f"it is larger than {limit / 2**20:g} MB", str(path))
    if data.startswith(LFS):
        raise OSError(
            0, "it is a pointer of Git LFS; run `git lfs pull` in its repository", str(path)
        )
    return data
