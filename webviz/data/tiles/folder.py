"""Tiles as files of a folder."""

from __future__ import annotations

import stat
from pathlib import Path

from webviz.data.tiles.source import MAX_BYTES, TileError

SUFFIXES = (".png", ".jpg", ".jpeg", ".webp")
LAYOUT = "{z}/{x}/{y}"


class Folder:
    """A folder of tiles, as servers of maps lay them out.

    Args:
        pattern: a path with `{z}`, `{x}` and `{y}`, or a folder with files such as `15/17/11.png`.
    """

    attribution = ""

    def __init__(self, pattern: str) -> None:
        self._has_fields = "{" in pattern
        self._pattern = pattern if self._has_fields else f"{pattern}/{LAYOUT}"

    def read(self, zoom: int, x: int, y: int) -> bytes | None:
        """Return the content of a file, None if there is none."""
        name = filled(self._pattern, zoom, x, y)
        for suffix in ("",) if self._has_fields else SUFFIXES:
            path = Path(name + suffix)
            try:
                about = path.stat()
                if not stat.S_ISREG(about.st_mode) or about.st_size > MAX_BYTES:
                    raise TileError(f"{path} is not a file of at most {MAX_BYTES >> 20} MB.")
                return path.read_bytes()
            except (FileNotFoundError, NotADirectoryError):
                continue
            except (OSError, ValueError) as error:
                raise TileError(f"{path} cannot be read: {error}.") from error
        return None


def filled(pattern: str, zoom: int, x: int, y: int) -> str:
    """Return a pattern with its fields replaced, and nothing else of it."""
    values = {"{z}": zoom, "{x}": x, "{y}": y}
    for field, value in values.items():
        pattern = pattern.replace(field, str(value))
    return pattern
