"""Map tiles: of MBTiles and PMTiles files, of folders, and of servers that the owner allows."""

from webviz.data.tiles.opening import open_tiles
from webviz.data.tiles.source import Cells, TileError, TileSource, decoded

__all__ = ["Cells", "TileError", "TileSource", "decoded", "open_tiles"]
