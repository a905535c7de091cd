"""Tiles in a PMTiles file of version 3."""

from __future__ import annotations

import json
import os
import zlib
from pathlib import Path

from pmtiles import tile as pm

from webviz.data.tiles.source import MAX_BYTES, TileError, plain

HEADER = 127
"""Bytes."""
MAX_DIRECTORY = 1 << 20
"""Bytes of a directory or of the metadata once unpacked: about 100 000 entries."""
MAX_DEPTH = 4
"""Largest depth of directories (the format's own limit)."""
RASTER = (pm.TileType.PNG, pm.TileType.JPEG, pm.TileType.WEBP)
PLAIN = (pm.Compression.UNKNOWN, pm.Compression.NONE)
_GZIP = 31
"""Window bits of zlib for gzip."""


class PMTiles:
    """A file of tiles.

    Args:
        path: of the file.

    Raises:
        TileError: it is damaged, or has tiles with vectors.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            self._header = pm.deserialize_header(self._bytes(0, HEADER))
        except pm.SpecVersionUnsupported:
            raise TileError(
                f"{path} is not of PMTiles 3. Convert it with `pmtiles convert`."
            ) from None
        except (pm.MagicNumberNotFound, ValueError, IndexError) as error:
            raise TileError(f"{path} is not a PMTiles file.") from error
        if self._header["tile_type"] not in RASTER:
            raise TileError(f"{path} has vector tiles, which are not supported. Use raster tiles.")
        if self._header["tile_compression"] not in PLAIN:
            raise TileError(f"{path} has compressed pictures, which are not supported.")
        if self._header["internal_compression"] != pm.Compression.GZIP:
            raise TileError(f"{path} has directories that are not compressed by gzip.")
        self.attribution = plain(self._metadata().get("attribution"))

    def read(self, zoom: int, x: int, y: int) -> bytes | None:
        """Return a tile, by way of at most four directories."""
        header, number = self._header, pm.zxy_to_tileid(zoom, x, y)
        offset, length = header["root_offset"], header["root_length"]
        for _ in range(MAX_DEPTH):
            packed = self._bytes(offset, length)
            self._unpacked(packed)  # bounded, as the library's own is not
            try:
                entry = pm.find_tile(pm.deserialize_directory(packed), number)
            except (EOFError, IndexError, ValueError, OverflowError) as error:
                raise TileError(f"{self._path} is damaged: a directory is not valid.") from error
            if entry is None:
                return None
            if entry.run_length:
                return self._bytes(header["tile_data_offset"] + entry.offset, entry.length)
            offset, length = header["leaf_directory_offset"] + entry.offset, entry.length
        raise TileError(f"{self._path} is damaged: its directories never end.")

    def _metadata(self) -> dict[str, object]:
        header = self._header
        if not header["metadata_length"]:
            return {}
        packed = self._bytes(header["metadata_offset"], header["metadata_length"])
        try:
            metadata = json.loads(self._unpacked(packed))
        except (ValueError, RecursionError):
            return {}
        return metadata if isinstance(metadata, dict) else {}

    def _unpacked(self, packed: bytes) -> bytes:
        unpacking = zlib.decompressobj(_GZIP)
        try:
            data = unpacking.decompress(packed, MAX_DIRECTORY)
        except zlib.error as error:
            raise TileError(f"{self._path} is damaged: {error}.") from error
        if unpacking.unconsumed_tail or unpacking.unused_data or not unpacking.eof:
            raise TileError(f"{self._path} has a directory of more than {MAX_DIRECTORY} bytes.")
        return data

    def _bytes(self, offset: int, length: int) -> bytes:
        if length > MAX_BYTES or offset >= 1 << 62:
            raise TileError(f"{self._path} is damaged: a part has {length} bytes.")
        with self._path.open("rb") as file:
            data = os.pread(file.fileno(), length, offset)
        if len(data) < length:
            raise TileError(f"{self._path} is cut off after {offset + len(data)} bytes.")
        return data
