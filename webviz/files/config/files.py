"""Reading config files from the disk."""

from __future__ import annotations

import codecs
import errno
import os
import stat
from pathlib import Path

from webviz.data.disk import within
from webviz.data.lfs import is_lfs
from webviz.files.config.errors import ConfigError

MAX_BYTES = 2 << 20
"""Real files have less than 0.2 MB."""
PATIENCE_S = 5.0
SUFFIXES = (".yaml", ".yml", ".rviz")
"""Suffixes of config files, in lower case."""
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def read_text(path: Path) -> str:
    """Return the text of a config file.

    Raises:
        ConfigError: it is missing, not a regular file, too large or not text, or the disk does not
            respond within some seconds. The sentence does not quote the file.
    """
    try:
        data = within(PATIENCE_S, lambda: _read(path))
    except OSError as error:
        raise ConfigError(f"Cannot read {path}: {error.strerror or error}.") from error
    refuse_too_large(len(data), str(path))
    if is_lfs(data):
        raise ConfigError(f"{path} is a Git LFS pointer: run `git lfs pull`.")
    try:
        return data.decode("utf-8-sig")  # editors on Windows write a byte order mark
    except UnicodeDecodeError as error:
        hint = "it is UTF-16, save it as UTF-8" if data.startswith(_UTF_16) else "not a config file"
        raise ConfigError(f"{path} is not UTF-8 text: {hint}.") from error


def refuse_too_large(size: int, where: str) -> None:
    """Refuse what is longer than any config.

    Args:
        size: in bytes, or in characters, of which a text has no more.
        where: names it.

    Raises:
        ConfigError: it is.
    """
    if size > MAX_BYTES:
        raise ConfigError(f"{where} is not a config file: it is larger than {MAX_BYTES >> 20} MB.")


def _read(path: Path) -> bytes:
    # Opening a FIFO would wait for a writer.
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY)
    try:
        mode = os.fstat(descriptor).st_mode
        if stat.S_ISDIR(mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if not stat.S_ISREG(mode):
            raise OSError(0, "it is not a regular file")
        with open(descriptor, "rb", closefd=False) as file:
            return file.read(MAX_BYTES + 1)
    finally:
        os.close(descriptor)


def is_rviz(path: Path) -> bool:
    """Return whether a file name ends with .rviz."""
    return path.suffix.lower() == ".rviz"
