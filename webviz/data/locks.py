"""Locks of open files, which end with the program; systems without `flock` have none."""

from __future__ import annotations

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None


def lock(descriptor: int, *, shared: bool = False) -> bool:
    """Lock an open file without waiting.

    Args:
        descriptor: of the file.
        shared: whether others may hold a shared lock, too.

    Returns:
        False on systems without such locks.

    Raises:
        BlockingIOError: another program holds it.
        OSError: the file system has no locks.
    """
    if fcntl is None:
        return False
    kind = fcntl.LOCK_SH if shared else fcntl.LOCK_EX
    fcntl.flock(descriptor, kind | fcntl.LOCK_NB)
    return True
