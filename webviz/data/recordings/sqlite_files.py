"""Files of SQLite databases that are cut off or not complete yet."""

from __future__ import annotations

import struct
from pathlib import Path

_HEADER = struct.Struct(">16xH10xI")
"""The page size and the number of pages at the beginning of a file."""


def journals(path: Path) -> list[str]:
    """Names of the files with changes that are not in the database yet."""
    names = [f"{path.name}{ending}" for ending in ("-wal", "-journal")]
    files = [path.with_name(name) for name in names]
    return [file.name for file in files if file.is_file() and file.stat().st_size]


def unread(path: Path, journal: str) -> str:
    """Return a sentence on a database and its journal."""
    return (
        f"{path.name} has no end: it is still being recorded, or its recorder was interrupted. "
        f"What only {journal} contains is not shown yet; open it again after the recording."
    )


def is_cut(path: Path) -> bool:
    """Return whether the file is smaller than its header says."""
    with path.open("rb") as file:
        header = file.read(_HEADER.size)
    if len(header) < _HEADER.size:
        return True
    page_size, pages = _HEADER.unpack(header)
    return path.stat().st_size < (page_size if page_size > 1 else 1 << 16) * pages
