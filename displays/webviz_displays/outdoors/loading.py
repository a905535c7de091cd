"""Loading of map tiles, a few at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import msgspec

from webviz import Context
from webviz.data.disk import DiskThreads
from webviz.data.tiles import Cells, TileError, TileSource, decoded, open_tiles

AT_ONCE = 2
"""Tiles that are loaded at once: half of the threads that all displays share."""
MARGIN_S = 5.0
"""For the disk, besides the time that a server has."""
MAX_FAILURES = 3
"""Tiles that fail one after the other until the rest is not tried: a server may be down."""

Tile = tuple[int, int, int]
"""Zoom, column, row."""

T = TypeVar("T")

_disk = DiskThreads(16)


class TileLoading(msgspec.Struct):
    """The tiles of one source.

    Args:
        address: of the source.
        timeout_s: for each answer of a server.
        source: once it is open.
        tiles: pixels of those that are needed and loaded; None where the map has none.
        failures: why tiles could not be loaded.
    """

    address: str
    timeout_s: float
    source: TileSource | None = None
    tiles: dict[Tile, Cells | None] = msgspec.field(default_factory=dict)
    failures: dict[Tile, str] = msgspec.field(default_factory=dict)

    def load(self, wanted: Sequence[Tile], ctx: Context) -> bool:
        """Go on with loading what is wanted, in this order, and forget the rest.

        Returns:
            Whether everything wanted has been tried.

        Raises:
            TileError: the source cannot be opened.
        """
        if self.source is None:
            self.source = ctx.background(
                ("tiles", self.address, self.timeout_s), _open, self.address, self.timeout_s
            )
            if self.source is None:
                return False
        needed = set(wanted)
        self.tiles = {tile: cells for tile, cells in self.tiles.items() if tile in needed}
        self.failures = {tile: why for tile, why in self.failures.items() if tile in needed}
        pending = 0
        for tile in wanted:
            if tile in self.tiles or tile in self.failures:
                continue
            if pending == AT_ONCE or len(self.failures) >= MAX_FAILURES:
                break
            work = (self.source, tile, self.timeout_s)
            try:
                loaded = ctx.background((self.address, tile), _load, *work)
            except TileError as error:
                self.failures[tile] = str(error)
                continue
            if loaded is None:
                pending += 1
            else:
                (self.tiles[tile],) = loaded
        return not pending


def _open(address: str, timeout_s: float) -> TileSource:
    return _within(timeout_s, address, lambda: open_tiles(address, timeout_s))


def _load(source: TileSource, tile: Tile, timeout_s: float) -> tuple[Cells | None]:
    """Return the pixels of a tile in a tuple, as None means that it is still being loaded."""
    content = _within(timeout_s, "The map", lambda: source.read(*tile))
    return (None if content is None else decoded(content),)


def _within(timeout_s: float, name: str, work: Callable[[], T]) -> T:
    """Return the result of work that a disk or server may never answer."""
    try:
        return _disk.within(timeout_s + MARGIN_S, work)
    except (OSError, RuntimeError) as error:
        raise TileError(f"{name} cannot be read: {error}.") from error
