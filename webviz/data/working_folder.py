"""Folders for unfinished work; what a killed program left of them goes with the next one."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import shutil
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

from webviz.data.locks import lock

LOCK = ".webviz_lock"
"""File of each of these folders; its program holds the lock until it ends, however it ends."""
ATTEMPTS = 10
"""Number of attempts to make a folder, of which each may fail as another program takes it for
abandoned."""


@contextlib.contextmanager
def working_folder(prefix: str, parent: Path | None = None) -> Iterator[Path]:
    """Provide a new folder that is removed afterwards.

    Those that killed programs of the same user left beside it are removed, too.

    Args:
        prefix: beginning of its name.
        parent: for it; None for the system's temporary folder.

    Raises:
        OSError: it cannot be made.
    """
    with contextlib.ExitStack() as stack:
        folder = _locked(prefix, parent, stack)
        _remove_abandoned(prefix, folder)
        yield folder


def _locked(prefix: str, parent: Path | None, stack: contextlib.ExitStack) -> Path:
    """Make a folder and hold its lock; another program may take it for abandoned before."""
    for _ in range(ATTEMPTS):
        folder = Path(tempfile.mkdtemp(prefix=prefix, dir=parent))
        stack.callback(_remove, folder)
        descriptor = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o600)
        stack.callback(os.close, descriptor)
        try:
            lock(descriptor)
        except BlockingIOError:  # it is being removed
            continue
        except OSError:  # a file system without locks: it stays
            return folder
        if (folder / LOCK).exists():
            return folder
    raise OSError(errno.EBUSY, os.strerror(errno.EBUSY))


def _remove_abandoned(prefix: str, beside: Path) -> None:
    """Remove the folders of the same user whose programs have ended."""
    own_name = re.compile(re.escape(prefix) + "[a-z0-9_]{8}")
    owner = beside.stat().st_uid
    with contextlib.suppress(OSError), os.scandir(beside.parent) as entries:
        for entry in entries:
            about = entry.stat(follow_symlinks=False)
            if (
                own_name.fullmatch(entry.name)
                and stat.S_ISDIR(about.st_mode)
                and about.st_uid == owner
            ):
                with contextlib.suppress(OSError):
                    remove_if_abandoned(Path(entry.path))


def remove_if_abandoned(folder: Path) -> None:
    """Remove a folder unless a program has its lock."""
    descriptor = os.open(folder / LOCK, os.O_RDWR)
    try:
        if lock(descriptor):
            _remove(folder)
    finally:
        os.close(descriptor)


def _remove(folder: Path) -> None:
    """Remove a folder, its lock at last: what a program leaves that is killed meanwhile has one."""
    with contextlib.suppress(OSError):
        for each in folder.iterdir():
            if each.is_dir() and not each.is_symlink():
                shutil.rmtree(each, ignore_errors=True)
            elif each.name != LOCK:
                each.unlink(missing_ok=True)
    shutil.rmtree(folder, ignore_errors=True)
