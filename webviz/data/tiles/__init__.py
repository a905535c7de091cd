"""Map tiles: of MBTiles and PMTiles files, of folders, and of servers that the owner allows."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import unquote, urlsplit

from webviz.data.tiles.folder import Folder
from webviz.data.tiles.server import TileServer
from webviz.data.tiles.source import Cells, TileError, TileSource, decoded

__all__ = ["Cells", "TileError", "TileSource", "decoded", "open_tiles"]

FIELDS = ("{z}", "{x}", "{y}")


def open_tiles(address: str, timeout_s: float) -> TileSource:
    """Open a source of tiles; may wait for a disk.

    Args:
        address: the path of an MBTiles or PMTiles file or of a folder, a pattern of paths, or one
            of addresses: `https://tiles.example/{z}/{x}/{y}.png`.
        timeout_s: for each answer of a server.

    Raises:
        TileError: it cannot be opened.
    """
    scheme = urlsplit(address).scheme if "://" in address else ""
    has_fields = all(field in address for field in FIELDS)
    if scheme in ("http", "https"):
        if not has_fields:
            raise TileError("The address of a server needs {z}, {x} and {y}.")
        return TileServer(address, timeout_s)
    if scheme not in ("", "file"):
        raise TileError(f"Addresses of the kind {scheme}:// are not supported.")
    name = unquote(urlsplit(address).path) if scheme else address
    if "\0" in name:
        raise TileError("The path is not valid.")
    try:
        path = Path(name).expanduser()
        is_folder, is_file = path.is_dir(), path.is_file()
    except (OSError, RuntimeError) as error:
        raise TileError(f"{name:.100} cannot be read: {error}.") from error
    if has_fields or is_folder:
        return Folder(str(path))
    if not is_file:
        raise TileError(f"{path} does not exist, or is not a file or folder.")
    if path.suffix == ".mbtiles":
        from webviz.data.tiles.mbtiles import MBTiles  # here, as SQLite takes 1 MB

        return MBTiles(path)
    if path.suffix == ".pmtiles":
        try:
            from webviz.data.tiles.pmtiles_file import PMTiles
        except ImportError as error:
            raise TileError(
                "PMTiles files need a library: pip install 'ros-webviz[outdoors]'."
            ) from error
        return PMTiles(path)
    raise TileError(f"{path} is neither an .mbtiles nor a .pmtiles file, nor a folder.")
