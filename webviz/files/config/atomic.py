"""Writing a file so that neither its old nor its new text is ever lost."""

from __future__ import annotations

import contextlib
import os
import secrets
import shutil
import stat
import time
from collections.abc import Iterator
from pathlib import Path

from webviz.data.disk import within
from webviz.data.locks import lock
from webviz.files.config.errors import ConfigError

BACKUP = ".bak"
"""Suffix of the file's previous version."""
LOCK_S = 0.5
"""Time to wait for another program saving in the same folder, which takes a millisecond."""
PATIENCE_S = 20.0
"""Time in seconds for the disk; a memory card that is busy takes seconds."""
POLL_S = 0.01


def write_text(text: str, path: Path) -> None:
    """Write a file atomically, and keep its previous version next to it as `NAME.bak`.

    The file is always complete, in its old or its new version. A link stays a link:
    its target is written. Mode and owner are kept. Unchanged text is not
    written again, which preserves the previous version.

    Raises:
        ConfigError: it cannot be written, and the file is unchanged; or the disk does not respond
            within some seconds, and the file may still be written later.
    """
    try:
        data = text.encode("utf-8")
        within(PATIENCE_S, lambda: _write(data, path))
    except OSError as error:
        raise ConfigError(
            f"Cannot write {path}: {error.strerror or error}; save it under another name."
        ) from error
    except UnicodeEncodeError as error:
        raise ConfigError(f"Cannot write {path}: it contains non-text data.") from error


def write_private(text: str, path: Path) -> None:
    """Write a file that only its owner can read, atomically; no previous version is kept.

    Raises:
        OSError: it cannot be written, and the file is unchanged.
    """
    target = Path(os.path.realpath(path))
    with _spare(target.parent) as spare:
        with os.fdopen(os.open(spare, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        spare.replace(target)


def _write(data: bytes, path: Path) -> None:
    if path.exists() and not path.is_file():  # such as /dev/stdout
        # Opening a FIFO would wait for a reader.
        with open(os.open(path, os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY), "wb") as file:
            os.set_blocking(file.fileno(), True)
            file.write(data)
        return
    target = Path(os.path.realpath(path))
    if not (target.exists() and target.read_bytes() == data):
        _replace(data, target)


def _replace(data: bytes, target: Path) -> None:
    before = target.stat() if target.exists() else None
    if before and not os.access(target, os.W_OK, effective_ids=True):
        raise PermissionError(0, "it is write-protected")
    with _spare(target.parent) as spare:
        with os.fdopen(os.open(spare, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666), "wb") as file:
            if before:
                os.fchmod(file.fileno(), stat.S_IMODE(before.st_mode))
                with contextlib.suppress(OSError):  # only root may give a file away
                    os.fchown(file.fileno(), before.st_uid, before.st_gid)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        with alone_in(target.parent) as folder:
            if target.exists():
                _keep(target)
            spare.replace(target)
            os.fsync(folder)


def _keep(target: Path) -> None:
    """Link the current content to the name of the previous version; the file itself stays."""
    with _spare(target.parent) as spare:
        try:
            os.link(target, spare)
        except OSError:  # a file system without hard links
            shutil.copy2(target, spare)
        try:
            spare.replace(target.with_name(target.name + BACKUP))
        except OSError as error:
            reason = f"{target.name}{BACKUP} cannot be replaced ({error.strerror})"
            raise OSError(error.errno, reason) from error


@contextlib.contextmanager
def _spare(folder: Path) -> Iterator[Path]:
    """Provide a temporary name; the file is removed afterwards unless it was renamed."""
    path = folder / f".{secrets.token_hex(8)}.tmp"
    try:
        yield path
    finally:
        path.unlink(missing_ok=True)


@contextlib.contextmanager
def alone_in(folder: Path) -> Iterator[int]:
    """Provide a folder's file descriptor, locked against other programs that save in it."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        _lock(descriptor)
        yield descriptor
    finally:
        os.close(descriptor)  # which ends the lock


def _lock(descriptor: int) -> None:
    deadline = time.monotonic() + LOCK_S
    while True:
        try:
            lock(descriptor)
            return
        except BlockingIOError:
            if time.monotonic() > deadline:
                raise OSError(0, "another program is saving in this folder; try again") from None
            time.sleep(POLL_S)
        except OSError:  # a file system without locks
            return
