"""Tiles in an SQLite database, as MBTiles 1.3 describes it."""

from __future__ import annotations

import contextlib
import sqlite3
import time
from collections.abc import Iterator
from pathlib import Path

from webviz.data import words
from webviz.data.recordings.recording import RecordingError
from webviz.data.recordings.sqlite_times import connected
from webviz.data.tiles.source import MAX_BYTES, MAX_REASON, TileError, plain

PATIENCE_S = 3.0
"""Time in seconds for one query: a database may define its table by anything that SQL can
compute."""
STEPS = 10_000
"""Number of steps of SQLite's virtual machine between two looks at the clock."""


class MBTiles:
    """A file of tiles.

    Args:
        path: of the file.

    Raises:
        TileError: it is damaged, or has tiles with vectors.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        with self._database() as db:
            rows = db.execute("SELECT name, value FROM metadata LIMIT 1000").fetchall()
        about = {name: value for name, value in rows if isinstance(name, str)}
        if about.get("format") == "pbf":
            raise TileError(f"{path} has vector tiles, which are not supported. Use raster tiles.")
        self.attribution = plain(about.get("attribution"))

    def read(self, zoom: int, x: int, y: int) -> bytes | None:
        """Return a tile; rows of the file count from the south."""
        with self._database() as db:
            row = db.execute(
                "SELECT tile_data FROM tiles "
                "WHERE zoom_level = ? AND tile_column = ? AND tile_row = ? "
                "AND typeof(tile_data) = 'blob' AND length(tile_data) <= ? LIMIT 1",
                (zoom, x, (1 << zoom) - 1 - y, MAX_BYTES),
            ).fetchone()
        return None if row is None else row[0]

    @contextlib.contextmanager
    def _database(self) -> Iterator[sqlite3.Connection]:
        until = time.monotonic() + PATIENCE_S
        try:
            with contextlib.closing(connected(self._path)) as db:
                db.set_progress_handler(lambda: time.monotonic() > until, STEPS)
                yield db
        except sqlite3.Error as error:
            # It may quote names of the database.
            reason = words.plain(str(error), MAX_REASON)
            raise TileError(f"{self._path} is damaged: {reason}.") from error
        except RecordingError as error:
            raise TileError(str(error)) from error
