"""Displays of places on the earth."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import PIL.Image
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from waiting import until

from webviz.data.geo import Geodetic, TilePlane, to_enu
from webviz.files import opening
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.outdoors import AerialMap, GeoPath, NavSatFix

FIX, PATH = "sensor_msgs/msg/NavSatFix", "geographic_msgs/msg/GeoPath"
HERE = Geodetic(48.1, 11.5, 500.0)
ZOOM = 17
NAN = float("nan")


def fix(latitude: float = HERE.latitude, longitude: float = HERE.longitude, **values: Any) -> Any:
    return {"latitude": latitude, "longitude": longitude, "altitude": HERE.altitude, **values}


FIXES = {FIX: fix(position_covariance=[4.0, 0, 0, 0, 1, 0, 0, 0, 9], position_covariance_type=2)}


def geo_path(*places: tuple[float, float]) -> dict[str, Any]:
    keys = ("latitude", "longitude")
    points = [dict(zip(keys, each, strict=True), altitude=510.0) for each in places]
    return {"poses": [{"pose": {"position": each}} for each in points]}


PATHS = {PATH: geo_path((48.1, 11.5), (48.101, 11.5), (48.101, 11.502))}


def write_tiles(folder: Path) -> Path:
    """Tiles around HERE in grey, as files."""
    file = io.BytesIO()
    PIL.Image.fromarray(np.full((8, 8, 3), 90, np.uint8)).save(file, "PNG")
    for x, y in TilePlane(HERE, ZOOM).around(1):
        path = folder / f"{ZOOM}/{x}/{y}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(file.getvalue())
    return folder


def loaded(at: DisplayBench) -> DisplayBench:
    """Turn until all tiles have been tried."""
    at.turn()
    until(lambda: not at.statuses()["Tiles"][1].startswith("Loading"), turn=at.turn)
    return at


@pytest.fixture
def map_bench(bench: Benches, tmp_path: Path) -> Callable[..., Any]:
    """A bench with tiles around a receiver that stands 10 m east of the origin of map."""

    def make(message: Mapping[str, Any] | None = None, **properties: Any) -> DisplayBench:
        folder = write_tiles(tmp_path / "tiles")
        values = {"object_uri": str(folder), "zoom": ZOOM, "blocks": 1} | properties
        at = bench(AerialMap(**values))
        at.transform("map", "gps", (10.0, 0.0, 2.0))
        at.send(FIX, message or fix(), frame="gps")
        return at

    return make


def test_tiles_lie_where_their_places_are(map_bench: Benches) -> None:
    at = loaded(map_bench())
    assert at.statuses()["Tiles"] == ("OK", "Showing 9 tiles.")
    poses = {key: pose for key, pose, _ in at.scene.visible()}
    plane = TilePlane(HERE, ZOOM)
    for x, y in plane.around(1):
        east, north = plane.corner(x, y)
        expected = (10.0 + east, north, 2.0)
        np.testing.assert_allclose(poses[f"{ZOOM}/{x}/{y}"].position, expected, atol=0.02)
    node = at.nodes()[f"{ZOOM}/{'/'.join(map(str, plane.around(0)[0]))}"]
    np.testing.assert_allclose((node.width, node.height), plane.size, rtol=1e-4)
    assert node.cells[0, 0].tolist() == [90, 90, 90, round(255 * 0.7)]


def test_a_new_fix_moves_the_map_and_sends_no_tile_again(map_bench: Benches) -> None:
    at = loaded(map_bench())
    before = at.nodes()
    poses = {key: pose.position for key, pose, _ in at.scene.visible()}
    neighbour = (HERE.latitude + 1e-5, HERE.longitude + 2e-5)
    at.send(FIX, fix(*neighbour), frame="gps")
    loaded(at)
    assert all(at.nodes()[key] is node for key, node in before.items())
    east, north, _ = to_enu([(*neighbour, HERE.altitude)], HERE)[0]
    for key, pose, _ in at.scene.visible():
        change = np.subtract(pose.position, poses[key])
        np.testing.assert_allclose(change, (-east, -north, 0.0), atol=1e-3)


@pytest.mark.parametrize(
    ("message", "properties", "key", "expected"),
    [
        ({"status": {"status": -1}}, {}, "Fix", ("ERROR", "The receiver has no fix.")),
        (fix(NAN), {}, "Fix", ("ERROR", "Latitude nan and longitude 11.5 are not a place")),
        (fix(88.0), {}, "Fix", ("ERROR", "Map tiles end at a latitude of 85.05°.")),
        (None, {"object_uri": ""}, "Tiles", ("WARN", "No tiles are chosen.")),
        (None, {"object_uri": "/none"}, "Tiles", ("ERROR", "/none does not exist")),
        (None, {"alpha": 0.0}, "Tiles", ("WARN", "Invisible: alpha is 0.")),
        (None, {"zoom": 3}, "Tiles", ("WARN", "The map has no tiles of level 3 here.")),
        (None, {"blocks": 2}, "Tiles", ("OK", "Showing 9 tiles.")),
    ],
)
def test_statuses_say_why_no_map_is_shown(
    map_bench: Benches,
    message: Any,
    properties: dict[str, Any],
    key: str,
    expected: tuple[str, str],
) -> None:
    at = map_bench(message, **properties)
    at.turn()
    if "Tiles" in at.statuses():
        loaded(at)
    level, text = at.statuses()[key]
    assert (level, text[: len(expected[1])]) == expected


def test_a_map_lies_behind_others_on_request(map_bench: Benches) -> None:
    layers = [
        {node.layer for node in loaded(map_bench(draw_behind=behind)).nodes().values()}
        for behind in (False, True)
    ]
    assert layers == [{0}, {-100_000}]


def test_damaged_tiles_are_reported_and_the_others_shown(
    map_bench: Benches, tmp_path: Path
) -> None:
    at = map_bench()
    x, y = TilePlane(HERE, ZOOM).around(1)[3]
    (tmp_path / f"tiles/{ZOOM}/{x}/{y}.png").write_bytes(b"vectors")
    loaded(at)
    level, text = at.statuses()["Tiles"]
    assert level == "WARN"
    assert text.startswith("Showing 8 of 9 tiles. A tile cannot be shown.")


def test_a_tile_that_is_selected_names_place_and_utm(map_bench: Benches) -> None:
    at = loaded(map_bench())
    key = "/".join(map(str, (ZOOM, *TilePlane(HERE, ZOOM).around(0)[0])))
    check_details(
        at.pick(key, None, (0.0, 0.0, 0.0)),
        f"Tile {key}",
        {"Latitude": "48.1000000°", "Longitude": "11.5000000°", "UTM": "32U 686121.76 5330438.13"},
    )


def test_a_path_of_places_lies_around_the_fix(bench: Benches) -> None:
    at = bench(GeoPath())
    at.transform("map", "gps", (10.0, 0.0, 2.0))
    at.send(PATH, PATHS[PATH], topic="/geo_path")
    at.turn()
    assert at.statuses()["Path"] == ("WARN", "Waiting for a fix on /gps/fix.")
    at.send(FIX, fix(), frame="gps", topic="/gps/fix")
    at.turn()
    assert at.statuses()["Path"] == ("OK", "Showing 3 poses.")
    flat = to_enu([(48.101, 11.5, 500.0), (48.101, 11.502, 500.0)], HERE) * (1, 1, 0)
    np.testing.assert_allclose(at.xyz("line")[:, 1], np.add(flat, (10.0, 0.0, 2.0)), atol=1e-3)


def test_invalid_places_are_counted(bench: Benches) -> None:
    at = bench(GeoPath())
    at.transform("map", "gps")
    at.send(FIX, fix(), frame="gps", topic="/gps/fix")
    at.send(PATH, geo_path((48.1, 11.5), (NAN, 0), (1e308, 0), (48.2, 11.5)), topic="/geo_path")
    at.turn()
    text = "2 poses of 4 are not places on the earth. Fix the publisher."
    assert at.statuses()["Path"] == ("ERROR", text)
    assert len(at.xyz("line")) == 1


def test_fixes_are_drawn_where_they_were(bench: Benches) -> None:
    at = bench(NavSatFix())
    at.transform("map", "gps", (10.0, 0.0, 0.0))
    for message in (fix(48.0999), {"status": {"status": -1}}, FIXES[FIX]):
        at.send(FIX, message, frame="gps")
        at.turn()
        at.now_ns += 10**9
    expected = np.add(to_enu([(48.0999, 11.5, 500.0), HERE], HERE), (10.0, 0.0, 0.0))
    np.testing.assert_allclose(at.xyz("fixes"), expected, atol=1e-4)
    reach = np.abs(at.xyz("deviation") - (10.0, 0.0, 0.0)).reshape(-1, 3).max(axis=0)
    np.testing.assert_allclose(reach, (2.0, 1.0, 0.0), atol=1e-3)
    assert at.statuses()["Fix"] == ("OK", "Showing 2 positions.")


def test_files_of_rviz_satellite_open_and_stay(tmp_path: Path) -> None:
    properties = {
        "Object URI": "https://tiles.example/{z}/{x}/{y}.png",
        "Zoom": 18,
        "Draw Behind": True,
    }
    topic = {"Topic": {"Value": "/fix"}}
    item = {
        "Class": "rviz_satellite/AerialMap",
        "Name": "Air",
        "Enabled": True,
        **properties,
        **topic,
    }
    path = tmp_path / "air.rviz"
    path.write_text(json.dumps({"Visualization Manager": {"Displays": [item]}}))
    config = opening.load(path)
    display = config.displays[0]
    assert isinstance(display, AerialMap)
    assert (display.object_uri, display.zoom, display.draw_behind) == tuple(properties.values())
    assert display.topic.name == "/fix"
    assert not config.report


class TestNavSatFix(BuiltInChecks):
    display = NavSatFix
    messages = FIXES
    values: ClassVar = {"history_length": (1,)}


class TestGeoPath(BuiltInChecks):
    display = GeoPath
    messages = FIXES | PATHS


class TestAerialMap(BuiltInChecks):
    display = AerialMap
    messages = FIXES
    # They need tiles: the tests above.
    elsewhere = ("alpha", "blocks", "draw_behind", "timeout", "zoom")
