"""Addresses of tiles in configs of others, of which a server sees no more than it is allowed."""

from __future__ import annotations

import http.server
import os
import tempfile
import threading
from pathlib import Path
from random import Random
from typing import Any
from urllib.parse import unquote

from tests.attack.attack import Case
from webviz.data.tiles import open_tiles
from webviz.data.tiles.server import VARIABLE

ALLOWED = "/maps/"
"""Folder of the server that the owner has allowed."""
TIMEOUT_S = 1.0
PARTS = ("..", ".", "%2e", "%252e", "%2f", "%5c", "\\", "/", "//", "a", "{z}", "{x}", "{y}", "..;")
PARTS += ("?", "#", "@", ":", "%00", "%0d%0a", "\r\n", " ", "\t", "é", "%c0%af", "%zz", "%", "maps")
STARTS = ("http://{place}/maps/",) * 6 + (
    *("http://{place}", "http://{place}@192.0.2.1/maps/", "http://192.0.2.1/maps/"),
    *("HTTP://{place}/maps/", "http:\\\\{place}\\maps\\", "http://u:p@{place}/maps/"),
    *("file://", "file:///proc/self/", "//{place}/maps/", "ftp://{place}/maps/", "/dev/", "~a/"),
)


def draw(random: Random) -> Case:
    """Make an address that tries to leave the folder, or to be another kind."""
    inner = "".join(random.choice(PARTS) for _ in range(random.randrange(8)))
    end = random.choice(("{z}/{x}/{y}.png", "{z}{x}{y}", ""))
    return Case("a.address", f"{random.choice(STARTS)}{inner}{end}".encode())


def read_address(path: Path) -> None:
    """Read a tile of the address in a file, as AerialMap does.

    Raises:
        TileError: the address is refused, or the tile does not exist.
        AssertionError: a server was asked for something outside of the folder.
    """
    requests: list[tuple[str, str]] = []

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            requests.append((self.path, self.headers.get("Host", "")))
            self.send_error(404)

        def log_message(self, format: str, *args: Any) -> None:
            """Nothing."""

    with (
        http.server.HTTPServer(("127.0.0.1", 0), Handler) as server,
        tempfile.TemporaryDirectory() as cache,
    ):
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        place = f"127.0.0.1:{server.server_address[1]}"
        os.environ[VARIABLE] = f"http://{place}{ALLOWED}"
        os.environ["XDG_CACHE_HOME"] = cache
        try:
            address = path.read_bytes().decode(errors="replace").replace("{place}", place)
            tiles = open_tiles(address, TIMEOUT_S)
            tiles.read(2, 1, 0)
        finally:
            server.shutdown()
            thread.join()
            for path_asked, host in requests:
                _check(path_asked, host, place)


def _check(path: str, host: str, place: str) -> None:
    """Check what a server was asked for, however it decodes that."""
    assert host == place, f"the server was asked as {host}"
    while (plain := unquote(path)) != path:
        path = plain
    folder = path.partition("?")[0].replace("\\", "/")
    assert folder.startswith(ALLOWED), f"{path} was asked for"
    assert ".." not in folder.split("/"), f"{path} was asked for"
