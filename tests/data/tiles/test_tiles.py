"""Map tiles of files, folders and a server."""

from __future__ import annotations

import contextlib
import gzip
import http.server
import io
import os
import sqlite3
import struct
import time
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import PIL.Image
import pytest
from pmtiles.tile import (
    Compression,
    TileType,
    deserialize_header,
    tileid_to_zxy,
    zxy_to_tileid,
)
from pmtiles.writer import Writer
from serving import serving

from webviz.data.tiles import TileError, decoded, open_tiles
from webviz.data.tiles import mbtiles as mbtiles_file
from webviz.data.tiles.pmtiles_file import PMTiles
from webviz.data.tiles.server import VARIABLE, TileCache, TileServer, is_allowed, user_cache
from webviz.data.tiles.source import MAX_BYTES, plain

TIMEOUT_S = 1.0


def picture(level: int = 0, kind: str = "PNG", size: int = 4) -> bytes:
    """A tile whose first row, in the north, is brighter than the others."""
    cells = np.full((size, size, 3), level, np.uint8)
    cells[0] += 100
    file = io.BytesIO()
    PIL.Image.fromarray(cells).save(file, kind)
    return file.getvalue()


def mbtiles(path: Path, **about: str) -> Path:
    db = sqlite3.connect(path)
    db.execute("CREATE TABLE metadata (name text, value text)")
    db.execute("CREATE TABLE tiles (zoom_level int, tile_column int, tile_row int, tile_data blob)")
    db.executemany("INSERT INTO metadata VALUES (?, ?)", about.items())
    db.execute("INSERT INTO tiles VALUES (2, 1, 3, ?)", (picture(),))
    db.commit()
    db.close()
    return path


ROOT = 8
"""Offset in a PMTiles file of the place and the size of its first directory."""


def pmtiles(
    path: Path, kind: TileType = TileType.PNG, contents: Mapping[int, bytes] | None = None
) -> Path:
    with path.open("wb") as file:
        writer = Writer(file)
        for number, content in (contents or {zxy_to_tileid(2, 1, 0): picture()}).items():
            writer.write_tile(number, content)
        header = {"tile_type": kind, "tile_compression": Compression.NONE}
        bounds = dict.fromkeys(("min_lon_e7", "min_lat_e7", "max_lon_e7", "max_lat_e7"), 0)
        writer.finalize(header | bounds, {"attribution": '<a href="x">&copy; Surveyors</a>'})
    return path


def test_rows_of_mbtiles_count_from_the_south(tmp_path: Path) -> None:
    path = mbtiles(tmp_path / "map.mbtiles", attribution="&copy; <b>Surveyors</b>")
    tiles = open_tiles(str(path), TIMEOUT_S)
    assert tiles.read(2, 1, 0) == picture()
    assert tiles.read(2, 1, 3) is None
    assert tiles.attribution == "© Surveyors"


def test_tiles_of_pmtiles_are_found_by_their_directories(tmp_path: Path) -> None:
    tiles = open_tiles(str(pmtiles(tmp_path / "map.pmtiles")), TIMEOUT_S)
    assert tiles.read(2, 1, 0) == picture()
    assert tiles.read(2, 1, 1) is None
    assert tiles.attribution == "© Surveyors"


def test_folders_and_patterns_of_paths_hold_files(tmp_path: Path) -> None:
    (tmp_path / "2/1").mkdir(parents=True)
    (tmp_path / "2/1/0.jpg").write_bytes(picture(kind="JPEG"))
    for address in (f"{tmp_path}", f"{tmp_path}/{{z}}/{{x}}/{{y}}.jpg", f"file://{tmp_path}"):
        tiles = open_tiles(address, TIMEOUT_S)
        assert tiles.read(2, 1, 0) == picture(kind="JPEG")
        assert tiles.read(2, 0, 0) is None


def test_pixels_begin_in_the_south() -> None:
    cells = decoded(picture())
    assert cells[:, 0, 0].tolist() == [0, 0, 0, 100]
    assert (cells[..., 3] == 255).all()


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "The compressed image is empty"),
        (b"\x1f\x8b vectors", "A tile cannot be shown."),
        (picture()[:48], "damaged"),
        (picture(size=1025), "1025 x 1025 pixels; the limit is 1024."),
    ],
    ids=["empty", "vectors", "cut off", "too large"],
)
def test_a_tile_that_is_not_an_image_is_refused(content: bytes, reason: str) -> None:
    with pytest.raises(TileError, match=reason):
        decoded(content)


@pytest.mark.parametrize(
    ("address", "reason"),
    [
        ("nowhere.mbtiles", "does not exist"),
        ("ftp://maps/{z}/{x}/{y}", "ftp:// are not supported"),
        ("https://maps.example/tiles", "needs {z}, {x} and {y}"),
        ("a\0b", "not valid"),
        ("/a\r\n\x1b[2Jb", r"^/a   \[2Jb does not exist"),
        ("x" * 5000, "cannot be read"),
    ],
)
def test_an_invalid_source_is_refused(address: str, reason: str) -> None:
    with pytest.raises(TileError, match=reason):
        open_tiles(address, TIMEOUT_S)


def test_damaged_and_hostile_files_are_refused_soon(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mbtiles_file, "PATIENCE_S", 0.3)  # of which all is spent
    path = tmp_path / "map.mbtiles"
    path.write_bytes(b"SQLite format 3\0" + os.urandom(2000))
    with pytest.raises(TileError):
        open_tiles(str(path), TIMEOUT_S)
    endless = tmp_path / "endless.mbtiles"
    db = sqlite3.connect(endless)
    db.execute(
        "CREATE VIEW metadata AS WITH RECURSIVE n(name) AS (SELECT 1 UNION ALL SELECT name + 1 "
        "FROM n) SELECT name, 1 AS value FROM n WHERE name < 0"
    )
    db.close()
    start = time.monotonic()
    with pytest.raises(TileError, match=r"endless\.mbtiles"):
        open_tiles(str(endless), TIMEOUT_S)
    assert time.monotonic() - start < 60.0
    with pytest.raises(TileError, match="vector tiles"):
        open_tiles(str(mbtiles(tmp_path / "vector.mbtiles", format="pbf")), TIMEOUT_S)
    with pytest.raises(TileError, match="vector tiles"):
        open_tiles(str(pmtiles(tmp_path / "vector.pmtiles", TileType.MVT)), TIMEOUT_S)


def test_a_pmtiles_file_that_is_cut_or_changed_anywhere_is_a_sentence(tmp_path: Path) -> None:
    whole = pmtiles(tmp_path / "map.pmtiles").read_bytes()
    path = tmp_path / "bad.pmtiles"
    random = np.random.default_rng(0)
    for _ in range(300):
        data = bytearray(whole)
        for at in random.integers(0, min(len(data), 400), 3):
            data[at] = random.integers(256)
        path.write_bytes(data[: random.integers(len(data))] if random.random() < 0.3 else data)
        with contextlib.suppress(TileError):
            PMTiles(path).read(2, 1, 0)


class Answers(http.server.BaseHTTPRequestHandler):
    """A server of tiles, some of which are traps."""

    requests: list[str]

    def do_GET(self) -> None:
        self.requests.append(self.path)
        if self.path.startswith("/away/"):
            self.send_response(302)
            self.send_header("Location", "/tiles/2/1/0")
            self.end_headers()
        elif self.path.startswith("/tiles/2/1/"):
            self.send_response(200)
            self.end_headers()
            self.wfile.write(picture())
        elif self.path.startswith("/slow/"):
            self.send_response(200)
            self.end_headers()
            for _ in range(100):
                self.wfile.write(b"x")
                self.wfile.flush()
                time.sleep(0.05)
        elif self.path.startswith("/sized/"):
            self.send_response(200)
            self.end_headers()
            self.wfile.write(bytes(int(self.path.split("/")[2])))
        elif self.path.startswith("/status/"):
            self.send_response(int(self.path.split("/")[2]))
            self.end_headers()
        elif self.path.startswith("/endless/"):
            self.send_response(200)
            self.end_headers()
            for _ in range(10_000):
                self.wfile.write(bytes(1 << 16))
        else:
            self.send_error(404 if self.path.startswith("/tiles/") else 500)

    def log_message(self, format: str, *args: object) -> None:
        """Nothing."""


class Serving(http.server.ThreadingHTTPServer):
    """Ignores clients that hang up early."""

    def handle_error(self, request: object, client_address: object) -> None:
        """Nothing."""


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[str, list[str]]]:
    requests: list[str] = []
    handler = type("Own", (Answers,), {"requests": requests})
    with serving(Serving(("127.0.0.1", 0), handler)) as served:
        address = f"http://127.0.0.1:{served.server_port}"
        monkeypatch.setenv(VARIABLE, f"https://other.example {address}/")
        yield address, requests


def test_each_tile_is_requested_once(server: tuple[str, list[str]], tmp_path: Path) -> None:
    address, requests = server
    tiles = TileServer(f"{address}/tiles/{{z}}/{{x}}/{{y}}", TIMEOUT_S, tmp_path)
    assert [tiles.read(2, 1, 0), tiles.read(2, 1, 0)] == [picture()] * 2
    assert requests == ["/tiles/2/1/0"]
    assert tiles.read(9, 9, 9) is None
    again = TileServer(f"{address}/tiles/{{z}}/{{x}}/{{y}}", TIMEOUT_S, tmp_path)
    assert again.read(2, 1, 0) == picture()
    assert len(requests) == 2
    assert tiles.attribution == "127.0.0.1"


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("away", "HTTP status 302"),
        ("broken", "HTTP status 500"),
        ("slow", "does not answer: timed out"),
        ("endless", "more than 4194304 bytes"),
    ],
)
def test_errors_of_a_server_are_one_sentence(
    server: tuple[str, list[str]], tmp_path: Path, path: str, reason: str
) -> None:
    timeout_s = 0.3 if path == "slow" else 30.0
    tiles = TileServer(f"{server[0]}/{path}/{{z}}/{{x}}/{{y}}", timeout_s, tmp_path)
    with pytest.raises(TileError, match=reason):
        tiles.read(2, 1, 0)
    assert len(server[1]) == 1, "a redirect is not followed"


def test_a_server_that_is_not_allowed_is_never_contacted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    with pytest.raises(TileError, match=rf"Restart with {VARIABLE}=https://maps\.example/"):
        open_tiles("https://maps.example/{z}/{x}/{y}.png", TIMEOUT_S)


@pytest.mark.parametrize(
    ("address", "is_so"),
    [
        ("https://maps.example/a/{z}", True),
        ("https://maps.example/b/{z}", False),
        ("http://maps.example/a/{z}", False),
        ("https://maps.example.evil/a/{z}", False),
        ("https://maps.example:444/a/{z}", False),
        ("https://user@maps.example/a/{z}", False),
        ("https://{x}.maps.example/a/{z}", False),
        ("file:///etc/passwd", False),
        ("https://maps.example/a/../b/{z}", False),
        ("https://maps.example/a/%2e%2E/b/{z}", False),
        ("https://maps.example/a/..%2fb/{z}", False),
        ("https://maps.example/a/..\\b/{z}", False),
        ("https://maps.example/a/%252e%252e/b/{z}", False),
        ("https://maps.example/a/x..y/{z}", True),
        ("https://maps.example/a/./{z}", False),
    ],
)
def test_an_allowed_server_allows_no_other(address: str, is_so: bool) -> None:
    assert is_allowed(address, ["https://maps.example/a/"]) == is_so


def test_the_oldest_tiles_go_when_the_cache_is_full(tmp_path: Path) -> None:
    cache = TileCache(tmp_path, "https://maps.example", limit=250)
    for number in range(4):
        cache.write(1, number, 0, bytes(100))
        path = next(tmp_path.rglob(f"1/{number}/0"))
        at = time.time() + number - 10
        os.utime(path, (at, at))
    cache.prune()
    assert [cache.read(1, number, 0) is not None for number in range(4)] == [0, 0, 1, 1]


def test_a_tile_of_the_largest_size_is_read_and_a_larger_one_is_not(
    server: tuple[str, list[str]], tmp_path: Path
) -> None:
    (tmp_path / "2/1").mkdir(parents=True)
    file = tmp_path / "2/1/0.png"
    for size, is_read in ((MAX_BYTES, True), (MAX_BYTES + 1, False)):
        file.write_bytes(bytes(size))
        path = tmp_path / f"{size}.mbtiles"
        db = sqlite3.connect(mbtiles(path))
        db.execute("UPDATE tiles SET tile_data = zeroblob(?)", (size,))
        db.commit()
        db.close()
        assert (open_tiles(str(path), TIMEOUT_S).read(2, 1, 0) is not None) == is_read
        with contextlib.nullcontext() if is_read else pytest.raises(TileError, match="4 MB"):
            assert open_tiles(str(tmp_path), TIMEOUT_S).read(2, 1, 0) == bytes(size)
        tiles = TileServer(f"{server[0]}/sized/{size}/{{z}}/{{x}}/{{y}}", 30.0, tmp_path / "kept")
        with contextlib.nullcontext() if is_read else pytest.raises(TileError, match="4194304"):
            assert tiles.read(2, 1, 0) == bytes(size)


@pytest.mark.parametrize("status", [204, 404, 410])
def test_a_missing_tile_is_requested_again(
    server: tuple[str, list[str]], tmp_path: Path, status: int
) -> None:
    tiles = TileServer(f"{server[0]}/status/{status}/{{z}}/{{x}}/{{y}}", TIMEOUT_S, tmp_path)
    assert [tiles.read(2, 1, 0), tiles.read(2, 1, 0)] == [None, None]
    assert len(server[1]) == 2


@pytest.mark.parametrize(
    ("host", "credit"),
    [
        ("tile.openstreetmap.org", "© OpenStreetMap contributors"),
        ("openstreetmap.org", "© OpenStreetMap contributors"),
        ("notopenstreetmap.org", "notopenstreetmap.org"),
    ],
)
def test_the_maker_of_a_map_is_credited(
    host: str, credit: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(VARIABLE, f"https://{host}/")
    tiles = TileServer(f"https://{host}/{{z}}/{{x}}/{{y}}", TIMEOUT_S, tmp_path)
    assert tiles.attribution == credit


def test_tiles_older_than_30_days_are_fetched_again(
    server: tuple[str, list[str]], tmp_path: Path
) -> None:
    tiles = TileServer(f"{server[0]}/tiles/{{z}}/{{x}}/{{y}}", TIMEOUT_S, tmp_path)
    for age_days, count in ((0, 1), (29, 1), (31, 2)):
        for path in filter(Path.is_file, tmp_path.rglob("*")):
            at = time.time() - age_days * 86_400
            os.utime(path, (at, at))
        assert tiles.read(2, 1, 0) == picture()
        assert len(server[1]) == count


def test_the_cache_of_a_session_stays_within_its_limit(tmp_path: Path) -> None:
    cache = TileCache(tmp_path, "https://maps.example", limit=10_000)
    for number in range(1000):
        cache.write(1, number, 0, bytes(100))
    assert sum(path.stat().st_size for path in tmp_path.rglob("0")) < 40_000


def test_the_error_of_a_truncated_pmtiles_file_names_the_place(tmp_path: Path) -> None:
    path = pmtiles(tmp_path / "map.pmtiles")
    tiles = PMTiles(path)
    size = path.stat().st_size - 1
    os.truncate(path, size)
    with pytest.raises(TileError, match=rf"map\.pmtiles is cut off after {size} bytes\."):
        tiles.read(2, 1, 0)


def test_a_directory_of_pmtiles_unpacks_to_one_megabyte_at_most(tmp_path: Path) -> None:
    path = pmtiles(tmp_path / "map.pmtiles")
    data = path.read_bytes()
    offset, length = struct.unpack_from("<QQ", data, ROOT)
    root = gzip.decompress(data[offset : offset + length])
    for size, is_read in ((1 << 20, True), ((1 << 20) + 1, False)):
        packed, larger = gzip.compress(root.ljust(size, b"\0")), bytearray(data)
        struct.pack_into("<QQ", larger, ROOT, len(data), len(packed))
        path.write_bytes(larger + packed)
        with (
            contextlib.nullcontext()
            if is_read
            else pytest.raises(TileError, match="more than 1048576 bytes")
        ):
            assert PMTiles(path).read(2, 1, 0) == picture()


def test_tiles_of_a_large_pmtiles_file_are_found_through_its_leaf_directories(
    tmp_path: Path,
) -> None:
    """The root has at most 16 kB; of more tiles, it names the directories that have them."""
    first = zxy_to_tileid(8, 0, 0)
    sizes = np.random.default_rng(0).integers(1, 128, 1 << 15).tolist()
    contents = {first + n: n.to_bytes(2, "big") * size for n, size in enumerate(sizes)}
    path = pmtiles(tmp_path / "map.pmtiles", contents=contents)
    with path.open("rb") as file:
        assert deserialize_header(file.read(127))["leaf_directory_length"] > 0
    tiles = PMTiles(path)
    for number in (first, first + 10_000, first + len(sizes) - 1):
        assert tiles.read(*tileid_to_zxy(number)) == contents[number]
    assert tiles.read(3, 0, 0) is None


def test_tiles_are_kept_in_the_cache_of_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert user_cache() == tmp_path / "webviz/tiles"
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert user_cache() == tmp_path / ".cache/webviz/tiles"


def test_attributions_are_texts_of_one_line() -> None:
    assert plain("<a href='x'>A &amp;\n B</a>" + " c" * 1000) == ("A & B" + " c" * 1000)[:300]
    assert plain("x" * 30_000) == ""
    assert plain(3) == ""


def test_a_database_that_takes_a_while_is_read(tmp_path: Path) -> None:
    path = mbtiles(tmp_path / "map.mbtiles")
    with contextlib.closing(sqlite3.connect(path)) as db:  # without an index, all rows are read
        db.execute("UPDATE tiles SET zoom_level = 3")
        rows = ((3, number, 0, b"x") for number in range(10_000))
        db.executemany("INSERT INTO tiles VALUES (?, ?, ?, ?)", rows)
        db.execute("INSERT INTO tiles VALUES (2, 1, 3, ?)", (picture(),))
        db.commit()
    assert open_tiles(str(path), TIMEOUT_S).read(2, 1, 0) == picture()
