"""The panel Outdoor map: tracks, tiles and what it says when there is nothing."""

from __future__ import annotations

import base64
import io
import math
from pathlib import Path
from typing import Any

import PIL.Image
import pytest
from waiting import until

from tests.support.panel_facts import LonePanel
from webviz.data.messages import decode, encode
from webviz.engine.state import State
from webviz.panels.outdoor_map import (
    FIX,
    MAX_POINTS,
    MAX_TILES,
    PATH,
    PER_PART,
    OutdoorMap,
    TileShelf,
)
from webviz.sources import Offer, Publisher


class LoneMap(LonePanel[OutdoorMap]):
    """A map with a fix and a route."""

    def __init__(self, **values: Any) -> None:
        types = {"/fix": FIX, "/route": PATH}
        offers = {
            topic: Offer((Publisher("/robot", type_, "reliable", "volatile"),))
            for topic, type_ in types.items()
        }
        super().__init__(OutdoorMap(**values), offers=offers)

    @property
    def widget(self) -> Any:
        return self.ui.widgets["0"]

    def fix(self, latitude: float, longitude: float, status: int = 0) -> None:
        values = {"latitude": latitude, "longitude": longitude, "status": {"status": status}}
        self.panel.take("/fix", decode(FIX, encode(FIX, values)))

    def route(self, *places: tuple[float, float]) -> None:
        positions = [{"latitude": north, "longitude": east} for north, east in places]
        values = {"poses": [{"pose": {"position": each}} for each in positions]}
        self.panel.take("/route", decode(PATH, encode(PATH, values)))

    def places(self, index: int) -> list[float]:
        """Longitudes and latitudes of a track, as a page joins them."""
        first, end = self.values()["tracks"][index]["parts"]
        parts = [self.widget.parts[f"track/{index}/{number}"] for number in range(first, end)]
        return [degree for part in parts for degree in part["places"]]


def test_fixes_make_a_track_and_a_path_replaces_the_one_before() -> None:
    bench = LoneMap()
    bench.fix(50.0, 8.0)
    bench.fix(50.00000001, 8.0)  # stands still
    bench.fix(50.1, 8.1)
    bench.route((50.0, 8.0), (51.0, 9.0))
    bench.route((52.0, 8.0))
    assert bench.places(0) == [8.0, 50.0, 8.1, 50.1]
    assert bench.places(1) == [8.0, 52.0]
    fix, route = bench.values()["tracks"]
    assert (fix["newest"], fix["is_path"]) == ([8.1, 50.1], False)
    assert (route["newest"], route["is_path"]) == (None, True)
    bench.panel.start_over()
    assert bench.places(0) == []


def test_a_long_track_is_sent_in_parts_and_has_a_bound() -> None:
    bench = LoneMap(topics=["/fix"])
    for i in range(MAX_POINTS + PER_PART):
        bench.fix(i / 1000, 8.0)
    places = bench.places(0)
    assert MAX_POINTS - PER_PART <= len(places) // 2 <= MAX_POINTS
    assert places[-1] == pytest.approx((MAX_POINTS + PER_PART - 1) / 1000)
    before = dict(bench.widget.parts)
    bench.fix(20.0, 8.0)
    bench.show()
    changed = [key for key, part in bench.widget.parts.items() if before.get(key) is not part]
    assert len(changed) == 1


@pytest.mark.parametrize(
    ("latitude", "longitude", "status"),
    [(math.nan, 8.0, 0), (1e308, 8.0, 0), (89.9, 8.0, 0), (50.0, math.inf, 0), (50.0, 8.0, -1)],
)
def test_invalid_places_are_reported(latitude: float, longitude: float, status: int) -> None:
    bench = LoneMap(topics=["/fix"])
    bench.fix(latitude, longitude, status)
    assert bench.places(0) == []
    assert bench.values()["problem"].startswith("/fix: 1 message without a place on the map.")
    bench.fix(50.0, 8.0)
    assert bench.values()["problem"].startswith("No tiles are chosen.")


def test_topics_without_a_publisher_are_reported() -> None:
    assert "on /gone" in LoneMap(topics=["/gone"]).values()["problem"]
    bench = LoneMap()
    bench.state = State()
    assert bench.values()["problem"].startswith("No publisher of NavSatFix or GeoPath.")
    assert LoneMap(topics=["/fix"]).values()["problem"] == "No place yet on /fix."


def png(folder: Path, name: str) -> bytes:
    buffer = io.BytesIO()
    PIL.Image.new("RGB", (8, 8), (90, 90, 90)).save(buffer, "PNG")
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(buffer.getvalue())
    return buffer.getvalue()


def test_a_page_gets_the_tiles_it_asks_for(tmp_path: Path) -> None:
    content = png(tmp_path, "3/4/2.png")
    bench = LoneMap(object_uri=str(tmp_path))
    bench.widget.use("[[3, 4, 2], [3, 4, 3], [3, 99, 0], [-1, 0, 0], [99, 0, 0]]", 7)
    until(lambda: bench.values() and "tile/3/4/3" in bench.widget.parts)
    tiles = {key: part for key, part in bench.widget.parts.items() if key.startswith("tile/")}
    assert tiles.keys() == {"tile/3/4/2", "tile/3/4/3"}
    assert base64.b64decode(tiles["tile/3/4/2"]["image"]) == content
    assert tiles["tile/3/4/3"]["image"] == ""
    with pytest.raises(ValueError, match="Expected"):
        bench.widget.use('"tiles"', 7)


def test_a_tile_that_is_not_an_image_is_reported_and_not_served(tmp_path: Path) -> None:
    path = tmp_path / "0/0/0.png"
    path.parent.mkdir(parents=True)
    path.write_bytes(b"<svg onload=alert(1)>")
    shelf = TileShelf(str(tmp_path), 1.0)
    shelf.want([(0, 0, 0)])
    until(lambda: shelf.parts())
    assert shelf.parts()["0/0/0"] == {"image": ""}
    assert shelf.problem


def test_tiles_of_a_server_that_is_not_allowed_are_not_loaded() -> None:
    shelf = TileShelf("http://127.0.0.1:9/{z}/{x}/{y}.png", 1.0)
    shelf.want([(0, 0, 0)])
    until(lambda: shelf.problem)
    assert "WEBVIZ_TILE_SERVERS" in shelf.problem


def test_the_least_recently_used_tiles_are_dropped(tmp_path: Path) -> None:
    png(tmp_path, "9/0/0.png")
    shelf = TileShelf(str(tmp_path), 1.0)
    for row in range(0, MAX_TILES + 100, 100):
        tiles = [(9, 0, 0), *((9, 1, row + i) for i in range(100))]
        shelf.want(tiles)
        until(lambda tiles=tiles: {"/".join(map(str, each)) for each in tiles} <= {*shelf.parts()})
    assert len(shelf.parts()) == MAX_TILES
    assert shelf.parts()["9/0/0"]["image"]
    assert "9/1/0" not in shelf.parts()
