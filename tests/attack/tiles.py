"""Map tiles: damaged databases and archives, and servers that answer something else."""

from __future__ import annotations

import io
import os
import socketserver
import sqlite3
import tempfile
import threading
from functools import cache
from pathlib import Path
from random import Random

from PIL import Image
from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer

from tests.attack.attack import Case, mutated
from tests.attack.media import png_of
from webviz.data.tiles import decoded, open_tiles
from webviz.data.tiles.server import VARIABLE, TileServer

TIMEOUT_S = 1.0
PLACE = (2, 1, 0)
"""Zoom, column and row of the only tile."""
ELSEWHERE = ("http://127.0.0.1:1/", "file:///etc/passwd", "//192.0.2.1/", "gopher://x/", "\x1b[2J")
"""Targets of redirections by servers."""
COMPUTED = (
    "CREATE VIEW tiles AS SELECT 2 zoom_level, 1 tile_column, 3 tile_row, "
    "zeroblob(1000000000) tile_data",
    "CREATE VIEW tiles AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x+1 FROM c) "
    "SELECT 2 zoom_level, x tile_column, 3 tile_row, x'00' tile_data FROM c",
    "CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data)",
)


@cache
def _tile(size: int = 8) -> bytes:
    file = io.BytesIO()
    Image.new("RGB", (size, size)).save(file, "PNG")
    return file.getvalue()


@cache
def _mbtiles(table: str = "") -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.mbtiles"
        db = sqlite3.connect(path)
        db.execute("CREATE TABLE metadata (name text, value text)")
        db.execute("INSERT INTO metadata VALUES ('attribution', '<script>x</script>')")
        if table:
            db.execute(table)
        else:
            db.execute("CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data)")
            db.execute("INSERT INTO tiles VALUES (2, 1, 3, ?)", (_tile(),))
        db.commit()
        db.close()
        return path.read_bytes()


@cache
def _pmtiles() -> bytes:
    file = io.BytesIO()
    writer = Writer(file)
    writer.write_tile(zxy_to_tileid(*PLACE), _tile())
    header = {"tile_type": TileType.PNG, "tile_compression": Compression.NONE}
    bounds = dict.fromkeys(("min_lon_e7", "min_lat_e7", "max_lon_e7", "max_lat_e7"), 0)
    writer.finalize(header | bounds, {"attribution": "x"})
    return file.getvalue()


def _answer(random: Random) -> bytes:
    """Return what a server sends for a tile."""
    match random.choice(("redirect", "status", "length", "chunked", "head", "bomb", "none")):
        case "redirect":
            code = random.choice((301, 302, 303, 307, 308))
            return f"HTTP/1.1 {code} x\r\nLocation: {random.choice(ELSEWHERE)}\r\n\r\n".encode()
        case "status":
            code = random.choice((0, 99, 204, 206, 404, 500, 999))
            return b"HTTP/1.1 %d x\x1b[31m\r\n\r\n" % code
        case "length":
            length = random.choice((b"-1", b"1e9", b"99999999999999999999", b"5"))
            return b"HTTP/1.1 200 OK\r\nContent-Length: " + length + b"\r\n\r\n" + _tile()
        case "chunked":
            size = random.choice((b"fffffffffffffffff", b"-5", b"g", b"10"))
            head = b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n"
            return head + size + b"\r\n" + _tile()
        case "head":
            name = random.choice((b"x" * 100_000, b"\xff", b"a: b\r\n" * 1000))
            return b"HTTP/1.1 200 OK\r\n" + name + b"\r\n\r\n" + _tile()
        case "bomb":
            edge = random.choice((1024, 1025, 65_535))
            body = png_of(edge, edge, 8, random.choice((0, 2, 3, 6)), random.choice((10, 4 << 20)))
            return b"HTTP/1.1 200 OK\r\nContent-Length: %d\r\n\r\n" % len(body) + body
        case _:
            return random.randbytes(random.randrange(40))


def draw(random: Random) -> Case:
    """Reads attacked tiles in a process of its own, as AerialMap does."""
    match random.choice(("mbtiles", "pmtiles", "http", "http")):
        case "mbtiles":
            data = _mbtiles(random.choice(("", "", *COMPUTED)))
            return Case("a.mbtiles", mutated(random, data))
        case "pmtiles":
            return Case("a.pmtiles", mutated(random, _pmtiles()))
        case _:
            answer = _answer(random)
            return Case("a.http", mutated(random, answer) if random.random() < 0.3 else answer)


def read_tiles(path: Path) -> None:
    """Read and decode the tile of a file, or of a server that answers with the bytes of the file.

    Raises:
        TileError: there is none that can be shown.
    """
    if path.suffix != ".http":
        tile = open_tiles(str(path), TIMEOUT_S).read(*PLACE)
    else:
        tile = _read_from_server(path.read_bytes())
    if tile is not None:
        decoded(tile)


def _read_from_server(answer: bytes) -> bytes | None:
    requests: list[bytes] = []

    class Handler(socketserver.StreamRequestHandler):
        def handle(self) -> None:
            requests.append(self.rfile.readline())
            while self.rfile.readline().strip():
                pass
            self.wfile.write(answer)

    with (
        socketserver.TCPServer(("127.0.0.1", 0), Handler) as server,
        tempfile.TemporaryDirectory() as folder,
    ):
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        try:
            root = f"http://127.0.0.1:{server.server_address[1]}/"
            os.environ[VARIABLE] = root
            tiles = TileServer(f"{root}{{z}}/{{x}}/{{y}}.png", TIMEOUT_S, Path(folder))
            return tiles.read(*PLACE)
        finally:
            server.shutdown()
            thread.join()
            assert len(requests) <= 1, "a redirection was followed"
