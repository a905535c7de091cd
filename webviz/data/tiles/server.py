"""Tiles of a server that the owner of the viewer allows, kept on the disk."""

from __future__ import annotations

import contextlib
import hashlib
import os
import tempfile
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Sequence
from http.client import HTTPException
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from webviz.data.tiles.folder import filled
from webviz.data.tiles.source import MAX_BYTES, MAX_REASON, TileError
from webviz.data.words import plain

VARIABLE = "WEBVIZ_TILE_SERVERS"
"""Environment variable: the beginnings of addresses that may be asked, separated by spaces."""
CACHE_BYTES = 500_000_000
"""Bytes that the tiles of all servers take on the disk at most."""
FRESH_S = 30 * 86_400.0
"""Age in seconds after which a tile is fetched anew."""
BETWEEN_PRUNING = 200
"""Tiles that are stored between two looks at the size of the cache."""
AGENT = "webviz (+ros-webviz)"
"""Servers refuse programs without a name."""
CREDITS = {
    "openstreetmap.org": "© OpenStreetMap contributors",
    "arcgisonline.com": "© Esri and its data providers",
    "mapbox.com": "© Mapbox © OpenStreetMap contributors",
}


class _NoRedirects(urllib.request.HTTPRedirectHandler):
    """Refuses redirections to addresses that are not allowed."""

    def redirect_request(self, *_args: Any, **_more: Any) -> None:
        """Return no other request."""


class TileServer:
    """Tiles by HTTP.

    Args:
        pattern: an address with `{z}`, `{x}` and `{y}`.
        timeout_s: for each answer.
        cache: folder for tiles; None for that of the user.

    Raises:
        TileError: the owner of the viewer has not allowed it.
    """

    def __init__(self, pattern: str, timeout_s: float, cache: Path | None = None) -> None:
        self._pattern, self._timeout_s = pattern, timeout_s
        host = urlsplit(pattern).hostname or ""
        if not is_allowed(pattern, os.environ.get(VARIABLE, "").split()):
            raise TileError(
                f"Tiles of {host or pattern} are not loaded: their server is not allowed. Restart "
                f"with {VARIABLE}={urlsplit(pattern).scheme}://{urlsplit(pattern).netloc}/, or use "
                "a file or folder."
            )
        self.attribution = next(
            (text for name, text in CREDITS.items() if f".{host}".endswith(f".{name}")), host
        )
        self._cache = TileCache(cache or user_cache(), pattern)
        self._opener = urllib.request.build_opener(_NoRedirects)

    def read(self, zoom: int, x: int, y: int) -> bytes | None:
        """Return a tile of the cache, or else of the server; None if that has none."""
        if (cached := self._cache.read(zoom, x, y)) is not None:
            return cached
        address = filled(self._pattern, zoom, x, y)
        request = urllib.request.Request(address, headers={"User-Agent": AGENT})
        until = time.monotonic() + self._timeout_s
        try:
            with self._opener.open(request, timeout=self._timeout_s) as answer:
                tile = bytearray()
                while piece := answer.read1(1 << 16):
                    tile += piece
                    if len(tile) > MAX_BYTES:
                        raise TileError(f"A tile of {self._host} has more than {MAX_BYTES} bytes.")
                    if time.monotonic() > until:
                        raise TimeoutError("timed out")
        except urllib.error.HTTPError as error:
            error.close()
            if error.code in (404, 410):
                return None
            raise TileError(f"{self._host} answers with HTTP status {error.code}.") from None
        except (OSError, HTTPException, ValueError) as error:
            if isinstance(error, TileError):
                raise
            reason = getattr(error, "reason", error)
            # A server may answer with any bytes instead of a status line.
            text = plain(str(reason), MAX_REASON)
            raise TileError(f"{self._host} does not answer: {text}.") from None
        if not tile:
            return None
        self._cache.write(zoom, x, y, bytes(tile))
        return bytes(tile)

    @property
    def _host(self) -> str:
        return urlsplit(self._pattern).netloc.rpartition("@")[2]


def is_allowed(address: str, allowed: Sequence[str]) -> bool:
    """Return whether an address begins with one of those that the owner named.

    Scheme, host and port must be equal, so that `https://maps.example` does not allow
    `https://maps.example.evil`; and no step of the path leads up again.
    """
    parts = urlsplit(address)
    if _leaves(parts.path):
        return False
    if parts.scheme not in ("http", "https") or "{" in parts.netloc:
        return False
    for each in allowed:
        allowed_parts = urlsplit(each)
        if (allowed_parts.scheme, allowed_parts.netloc) == (
            parts.scheme,
            parts.netloc,
        ) and parts.path.startswith(allowed_parts.path):
            return True
    return False


def _leaves(path: str) -> bool:
    """Return whether a server may read a path as one of another folder, however often encoded."""
    while (plain := unquote(path)) != path:
        path = plain
    return not {".", ".."}.isdisjoint(path.replace("\\", "/").split("/"))


def user_cache() -> Path:
    """Return the folder for tiles of the user who runs the viewer."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "webviz" / "tiles"


class TileCache:
    """Files of tiles, of which the oldest go when there are too many; without a disk, none.

    Args:
        folder: for the tiles of all servers.
        pattern: of the server.
        limit: bytes.
    """

    _lock = threading.Lock()

    def __init__(self, folder: Path, pattern: str, limit: int = CACHE_BYTES) -> None:
        self._all, self._limit = folder, limit
        self._own = folder / hashlib.sha256(pattern.encode()).hexdigest()[:16]
        self._stored = 0

    def read(self, zoom: int, x: int, y: int) -> bytes | None:
        """Return a tile that is there and fresh."""
        path = self._path(zoom, x, y)
        try:
            is_fresh = time.time() - path.stat().st_mtime < FRESH_S
            return path.read_bytes() if is_fresh else None
        except OSError:
            return None

    def write(self, zoom: int, x: int, y: int, tile: bytes) -> None:
        """Keep a tile."""
        path = self._path(zoom, x, y)
        with contextlib.suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
                file.write(tile)
            os.replace(file.name, path)
        self._stored += 1
        if self._stored % BETWEEN_PRUNING == 1:
            self.prune()

    def prune(self) -> None:
        """Remove the oldest tiles of all servers beyond the limit."""
        with self._lock, contextlib.suppress(OSError):
            entries = [(path, path.stat()) for path in self._all.rglob("*") if path.is_file()]
            total = sum(about.st_size for _, about in entries)
            for path, about in sorted(entries, key=lambda each: each[1].st_mtime):
                if total <= self._limit:
                    break
                path.unlink(missing_ok=True)
                total -= about.st_size

    def _path(self, zoom: int, x: int, y: int) -> Path:
        return self._own / str(zoom) / str(x) / str(y)
