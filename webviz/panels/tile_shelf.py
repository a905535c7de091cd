"""Map tiles that pages asked for, read beside the frame loop."""

from __future__ import annotations

import base64
import threading
from collections import OrderedDict
from collections.abc import Iterable, Mapping
from typing import Any

from webviz.data.disk import DiskThreads
from webviz.data.geo import MAX_ZOOM
from webviz.data.tiles import TileError, TileSource, decoded, open_tiles

Tile = tuple[int, int, int]
"""Level, column from the west and row from the north."""

MAX_TILES = 200
"""Tiles that are kept; of more, those that were not asked for longest go."""
MAX_BYTES = 300_000
"""Of a tile as a page receives it."""

_disk = DiskThreads(4)


class TileShelf:
    """The tiles of one map.

    Args:
        address: see `webviz.data.tiles.open_tiles`.
        timeout_s: that a server has for each tile.
    """

    def __init__(self, address: str, timeout_s: float) -> None:
        self.address = address
        self.problem = ""
        """Why the newest tile could not be read, a sentence or ""."""
        self.attribution = ""
        self.timeout_s = timeout_s
        self._lock = threading.Lock()
        self._tiles: OrderedDict[Tile, Mapping[str, Any]] = OrderedDict()
        self._wanted: OrderedDict[Tile, None] = OrderedDict()
        self._source: TileSource | None = None
        self._is_busy = False

    def want(self, tiles: Iterable[Tile]) -> None:
        """Read these tiles as soon as possible, in place of those that are still waited for."""
        with self._lock:
            self._wanted.clear()
            for tile in [each for each in tiles if is_tile(each)][:MAX_TILES]:
                if tile in self._tiles:
                    self._tiles.move_to_end(tile)
                else:
                    self._wanted[tile] = None
            if self._is_busy or not self._wanted or not self.address:
                return
            self._is_busy = True
        try:
            _disk.start(self._read)
        except OSError as error:
            self.problem = f"Tiles cannot be read: {error}."
            self._is_busy = False

    def parts(self) -> dict[str, Mapping[str, Any]]:
        """Return the tiles by level, column and row with slashes between; "" is none there."""
        with self._lock:
            return {"/".join(map(str, tile)): part for tile, part in self._tiles.items()}

    def _read(self) -> None:
        while True:
            with self._lock:
                if not self._wanted:
                    self._is_busy = False
                    return
                tile, _ = self._wanted.popitem(last=False)
            part = self._part(tile)
            with self._lock:
                self._tiles[tile] = part
                while len(self._tiles) > MAX_TILES:
                    self._tiles.popitem(last=False)

    def _part(self, tile: Tile) -> Mapping[str, Any]:
        """Return a tile for pages, an empty one if there is none."""
        try:
            if self._source is None:
                self._source = open_tiles(self.address, self.timeout_s)
                self.attribution = self._source.attribution
            content = self._source.read(*tile)
            if content is not None:
                decoded(content)  # browsers get nothing that is not an image
                if len(content) > MAX_BYTES:
                    raise TileError(f"A tile has {len(content)} bytes; the limit is {MAX_BYTES}.")
        except (TileError, OSError) as error:
            self.problem = str(error)
            content = None
        else:
            self.problem = ""
        return {"image": base64.b64encode(content or b"").decode()}


def is_tile(tile: Tile) -> bool:
    """Return whether there is such a place in Web Mercator."""
    zoom, x, y = tile
    return 0 <= zoom <= MAX_ZOOM and 0 <= x < 1 << zoom and 0 <= y < 1 << zoom
