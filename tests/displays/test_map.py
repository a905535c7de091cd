"""The Map display: grids and updates to tiles."""

import math
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import maps
from inspecting import QUARTER, Benches
from mapping_scenes import COSTMAP, costmaps
from numpy.typing import ArrayLike

from webviz import Image, Topic
from webviz.api.nodes import Pose
from webviz.shell.testing import DisplayBench, check_details
from webviz.shell.testing.messages import header
from webviz_displays.map import Costmap, Map
from webviz_displays.map.palettes import lookup_table
from webviz_displays.map.tiles import LONGEST_TILE, MAX_CELLS, MAX_TILES, TILE

GRID = "nav_msgs/msg/OccupancyGrid"
UPDATE = "map_msgs/msg/OccupancyGridUpdate"


def grid_values(
    cells: ArrayLike,
    resolution: float = 0.5,
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
    xyzw: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0),
) -> dict[str, Any]:
    cells = np.asarray(cells, np.int8)
    position = dict(zip("xyz", origin, strict=True))
    orientation = dict(zip("xyzw", xyzw, strict=True))
    info = {
        "resolution": resolution,
        "width": cells.shape[1],
        "height": cells.shape[0],
        "origin": {"position": position, "orientation": orientation},
    }
    return {"info": info, "data": cells.ravel()}


def update_values(x: int, y: int, cells: ArrayLike) -> dict[str, Any]:
    cells = np.asarray(cells, np.int8)
    return {
        "x": x,
        "y": y,
        "width": cells.shape[1],
        "height": cells.shape[0],
        "data": cells.ravel(),
    }


def send_map(at: DisplayBench, cells: ArrayLike, **options: Any) -> None:
    at.send(GRID, grid_values(cells, **options), frame="map", topic="/map")
    at.turn()


def send_update(at: DisplayBench, x: int, y: int, cells: ArrayLike) -> None:
    at.send(UPDATE, update_values(x, y, cells), frame="map", topic="/map_updates")
    at.turn()


def whole_picture(at: DisplayBench) -> np.ndarray:
    """The tiles put together again."""
    tiles = {tuple(map(int, key.split()[1:])): node for key, node in at.nodes().items()}
    rows = max(row + tile.rgba.shape[0] for (row, _), tile in tiles.items())
    columns = max(column + tile.rgba.shape[1] for (_, column), tile in tiles.items())
    picture = np.zeros((rows, columns, 4), np.uint8)
    for (row, column), tile in tiles.items():
        picture[row : row + tile.rgba.shape[0], column : column + tile.rgba.shape[1]] = tile.rgba
    return picture


def corner_of_cell(pose: Pose, x: float, y: float) -> tuple[float, float, float]:
    """Return where a point of a tile lies in the fixed frame; tiles here turn about z only."""
    w, _, _, z = pose.wxyz
    yaw = 2 * math.atan2(z, w)
    px, py, pz = pose.position
    return (
        px + x * math.cos(yaw) - y * math.sin(yaw),
        py + x * math.sin(yaw) + y * math.cos(yaw),
        pz,
    )


@pytest.fixture
def at(bench: Benches) -> DisplayBench:
    """The bench of a map."""
    return bench(Map())


def test_a_map_is_drawn_cell_by_cell_in_the_colours_of_its_scheme(
    bench: Benches,
) -> None:
    at = bench(Map(alpha=1.0))
    cells = [[0, 100, -1], [50, 99, 1]]
    send_map(at, cells)
    expected = lookup_table("map")[np.array(cells, np.int8).view(np.uint8)]
    assert (whole_picture(at) == expected).all()
    node = at.nodes()["tile 0 0"]
    assert isinstance(node, Image)
    assert (node.width, node.height) == (1.5, 1.0)
    assert at.statuses()["Map"] == ("OK", "3 x 2 cells of 0.5 m in frame 'map'.")


def test_no_tile_is_larger_than_allowed_and_together_they_are_the_map(
    bench: Benches,
) -> None:
    at = bench(Map(alpha=1.0))
    cells = np.random.default_rng(0).integers(-1, 101, (TILE + 44, 2 * TILE + 8), np.int8)
    send_map(at, cells)
    assert len(at.nodes()) == 6
    assert all(max(node.rgba.shape[:2]) <= TILE for node in at.nodes().values())
    assert (whole_picture(at) == lookup_table("map")[cells.view(np.uint8)]).all()


@pytest.mark.parametrize("shape", [(1, 1_000_000), (1_000_000, 1), (3, 400_000), (9000, 9000)])
def test_a_map_of_any_shape_is_a_bounded_number_of_images(
    bench: Benches, shape: tuple[int, int]
) -> None:
    at = bench(Map(alpha=1.0))
    cells = np.zeros(shape, np.int8)
    cells[-1, -1] = 100
    send_map(at, cells)
    at.settle()
    nodes = at.nodes()
    assert len(nodes) <= MAX_TILES
    assert sum(node.cells.size for node in nodes.values()) == cells.size
    assert max(max(node.cells.shape) for node in nodes.values()) <= LONGEST_TILE
    send_update(at, shape[1] - 1, shape[0] - 1, [[0]])
    assert sum(node is nodes[key] for key, node in at.nodes().items()) == len(nodes) - 1


def test_a_map_longer_than_any_picture_is_refused(at: DisplayBench) -> None:
    send_map(at, np.zeros((1, MAX_CELLS + 1)))
    assert "at most 1048576 along an edge" in at.statuses()["Map"][1]


def test_tiles_lie_along_the_axes_of_an_origin_with_yaw(at: DisplayBench) -> None:
    half = math.radians(90) / 2
    yaw = (0.0, 0.0, math.sin(half), math.cos(half))
    send_map(at, np.zeros((TILE + 44, TILE + 44)), resolution=0.1, origin=(5.0, 7.0, 1.0), xyzw=yaw)
    poses = at.poses()
    # Columns run along the origin's x, which is y of the map; rows along its y, which is -x.
    assert corner_of_cell(poses["tile 0 0"], 0, 0) == pytest.approx((5.0, 7.0, 1.0))
    assert poses[f"tile 0 {TILE}"].position == pytest.approx((5.0, 7.0 + 0.1 * TILE, 1.0))
    assert poses[f"tile {TILE} 0"].position == pytest.approx((5.0 - 0.1 * TILE, 7.0, 1.0))
    assert corner_of_cell(poses["tile 0 0"], 1.0, 2.0) == pytest.approx((3.0, 8.0, 1.0))


def test_a_map_follows_its_frame(bench: Benches) -> None:
    at = bench(Map(), fixed_frame="odom")
    at.transform("odom", "map", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    send_map(at, [[0]])
    assert at.poses()["tile 0 0"].position == pytest.approx((1.0, 0.0, 0.0))
    at.transform("odom", "map", (2.0, 0.0, 0.0), stamp_ns=at.now_ns + 10**9)
    at.turn(1.0)
    assert at.poses()["tile 0 0"].position == pytest.approx((2.0, 0.0, 0.0))


def test_a_map_is_placed_at_the_time_of_now_and_not_of_the_newest_transform(
    bench: Benches,
) -> None:
    at = bench(Map(), fixed_frame="odom")
    at.transform("odom", "map", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    at.transform("odom", "map", (2.0, 0.0, 0.0), stamp_ns=at.now_ns + 10**9)
    send_map(at, [[0]])
    at.turn(0.5)
    assert at.poses()["tile 0 0"].position == pytest.approx((1.5, 0.0, 0.0))


def test_with_use_timestamp_a_map_stays_where_its_frame_was(bench: Benches) -> None:
    at = bench(Map(use_timestamp=True), fixed_frame="odom")
    at.transform("odom", "map", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    send_map(at, [[0]], origin=(0.0, 3.0, 0.0))
    at.transform("odom", "map", (2.0, 0.0, 0.0), stamp_ns=at.now_ns + 10**9)
    at.turn(1.0)
    assert at.poses()["tile 0 0"].position == pytest.approx((1.0, 3.0, 0.0))


def test_with_use_timestamp_an_update_changes_cells_and_not_the_place(
    bench: Benches,
) -> None:
    at = bench(Map(use_timestamp=True), fixed_frame="odom")
    at.transform("odom", "map", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    send_map(at, [[0]])
    before = at.nodes()["tile 0 0"]
    at.now_ns += 10**9  # no transform is known at this stamp
    send_update(at, 0, 0, [[100]])
    assert at.nodes()["tile 0 0"] != before
    assert at.poses()["tile 0 0"].position == pytest.approx((1.0, 0.0, 0.0))


def test_use_timestamp_without_a_transform_then_or_a_stamp_follows_the_frame(
    bench: Benches,
) -> None:
    at = bench(Map(), fixed_frame="odom")
    at.transform("odom", "map", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    at.send(GRID, grid_values([[0]]), frame="map", stamp_ns=10**9, topic="/map")
    at.turn()
    at.set("use_timestamp", True)
    assert at.poses()["tile 0 0"].position == pytest.approx((1.0, 0.0, 0.0))
    assert at.statuses()["Transform"][0] == "WARN"
    at.send(GRID, {**grid_values([[0]]), "header": header("map", 0)}, topic="/map")
    at.turn()
    assert at.poses()["tile 0 0"].position == pytest.approx((1.0, 0.0, 0.0))
    assert at.statuses()["Transform"][0] == "OK"


def test_a_map_in_a_new_fixed_frame_needs_no_new_message(at: DisplayBench) -> None:
    at.transform("odom", "map", (4.0, 0.0, 0.0))
    send_map(at, [[0]])
    at.fixed_frame = "odom"
    at.turn()
    assert at.poses()["tile 0 0"].position == pytest.approx((4.0, 0.0, 0.0))


def test_an_update_replaces_only_its_tiles(bench: Benches) -> None:
    at = bench(Map(alpha=1.0))
    cells = np.zeros((TILE + 44, TILE + 44), np.int8)
    send_map(at, cells)
    before = at.nodes()
    send_update(at, TILE - 6, 10, np.full((5, 10), 100))
    after = at.nodes()
    cells[10:15, TILE - 6 : TILE + 4] = 100
    assert (whole_picture(at) == lookup_table("map")[cells.view(np.uint8)]).all()
    same = {key for key in after if after[key] is before[key]}
    assert same == {f"tile {TILE} 0", f"tile {TILE} {TILE}"}
    assert at.statuses()["Update"] == ("OK", "1 update since the last whole map.")


def test_one_changed_cell_replaces_one_tile(at: DisplayBench) -> None:
    cells = np.zeros((TILE + 44, TILE + 44), np.int8)
    send_map(at, cells)
    before = at.nodes()
    cells[-1, -1] = 100
    send_map(at, cells)
    after = at.nodes()
    assert {key for key in after if after[key] is not before[key]} == {f"tile {TILE} {TILE}"}


def test_an_origin_with_a_zero_rotation_is_drawn_and_reported(at: DisplayBench) -> None:
    send_map(at, [[0]])
    assert "Orientation" not in at.statuses()
    send_map(at, [[0]], xyzw=(0.0, 0.0, 0.0, 0.0))
    assert list(at.nodes()) == ["tile 0 0"]
    assert at.statuses()["Orientation"] == (
        "OK",
        "The rotation of the origin is all zeros, taken as none.",
    )


def test_a_smaller_map_leaves_no_tile_of_the_larger_one(at: DisplayBench) -> None:
    send_map(at, np.zeros((TILE + 1, TILE + 1)))
    send_map(at, np.zeros((2, 2)))
    assert list(at.nodes()) == ["tile 0 0"]


@pytest.mark.parametrize(("x", "y"), [(-1, 0), (0, -1), (3, 0), (0, 2)])
def test_an_update_outside_of_the_map_is_refused(at: DisplayBench, x: int, y: int) -> None:
    send_map(at, np.zeros((3, 4)))
    before = at.nodes()["tile 0 0"]
    send_update(at, x, y, [[100, 100], [100, 100]])
    assert at.nodes()["tile 0 0"] is before
    level, text = at.statuses()["Update"]
    assert level == "ERROR"
    assert f"2 x 2 cells at ({x}, {y}) reaches outside of the map of 4 x 3" in text


def test_an_update_with_too_little_data_is_refused(at: DisplayBench) -> None:
    send_map(at, np.zeros((3, 4)))
    values = update_values(0, 0, [[100, 100]]) | {"height": 2}
    at.send(UPDATE, values, frame="map", topic="/map_updates")
    at.turn()
    assert at.statuses()["Update"] == (
        "ERROR",
        "The update's size is 2 x 2 = 4 cells, but its data has 2. Fix the publisher.",
    )


def test_an_update_in_another_frame_is_refused(at: DisplayBench) -> None:
    at.transform("map", "odom")
    send_map(at, [[0]])
    at.send(UPDATE, update_values(0, 0, [[100]]), frame="odom", topic="/map_updates")
    at.turn()
    assert at.statuses()["Update"][1] == "The update is in frame 'odom', the map in 'map'."


def test_updates_come_from_the_topic_beside_the_map(bench: Benches) -> None:
    at = bench(Map(topic=Topic("/global_costmap/costmap")))
    assert set(at.runner.subscriptions()) == {
        "/global_costmap/costmap",
        "/global_costmap/costmap_updates",
    }


def test_a_map_without_updates_is_ok(at: DisplayBench) -> None:
    send_map(at, [[0]])
    assert {level for level, _ in at.statuses().values()} == {"OK"}


def test_an_empty_update_changes_nothing(at: DisplayBench) -> None:
    send_map(at, [[0]])
    before = at.nodes()["tile 0 0"]
    send_update(at, 0, 0, np.zeros((0, 0)))
    assert at.nodes()["tile 0 0"] is before


def test_updates_before_the_map_are_ignored(at: DisplayBench) -> None:
    send_update(at, 0, 0, [[100]])
    assert at.nodes() == {}
    assert at.statuses()["Map"] == (
        "WARN",
        "No map received. Start the map server or choose another topic.",
    )
    send_map(at, [[0]])
    assert at.statuses()["Map"][0] == "OK"


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"info": {"width": 0, "height": 3}}, "size is 0 x 3"),
        ({"info": {"width": 2, "height": 2}}, "2 x 2 = 4 cells, but its data has 6"),
        ({"info": {"width": 2**32 - 1, "height": 2**32 - 1}}, "but its data has 6"),
        ({"info": {"resolution": 0.0}}, "resolution is 0 m"),
        ({"info": {"resolution": math.nan}}, "resolution is nan m"),
        ({"info": {"resolution": math.inf}}, "resolution is inf m"),
        ({"info": {"resolution": 1e38}}, "resolution is 1e+38 m"),
        ({"info": {"resolution": 1e-38}}, "it must be at least 1e-06 m"),
        ({"info": {"origin": {"position": {"y": 1e308}}}}, "origin is (0, 1e+308, 0)"),
        ({"info": {"origin": {"position": {"x": math.nan}}}}, "origin is not finite"),
        ({"info": {"origin": {"orientation": {"w": math.inf}}}}, "origin is not finite"),
    ],
)
def test_an_invalid_map_has_a_status(
    at: DisplayBench, change: dict[str, Any], sentence: str
) -> None:
    values = grid_values(np.zeros((2, 3)))
    values["info"] = values["info"] | change["info"]
    at.send(GRID, values, frame="map", topic="/map")
    at.turn()
    level, text = at.statuses()["Map"]
    assert level == "ERROR"
    assert sentence in text
    assert at.nodes() == {}


def test_after_a_map_that_cannot_be_drawn_the_one_before_stays_as_it_was(
    bench: Benches,
) -> None:
    at = bench(Map(use_timestamp=True), fixed_frame="odom")
    at.transform("odom", "map", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    send_map(at, [[0, 100]])
    before, pose = at.nodes()["tile 0 0"], at.poses()["tile 0 0"]
    at.transform("odom", "map", (2.0, 0.0, 0.0), stamp_ns=at.now_ns + 10**9)
    at.now_ns += 10**9
    broken = grid_values([[0, 100]], resolution=0.0)
    at.send(GRID, broken, frame="map", topic="/map")
    at.turn()
    send_update(at, 0, 0, [[100]])
    assert at.nodes()["tile 0 0"] is before
    assert at.poses()["tile 0 0"] == pose
    level, text = at.statuses()["Map"]
    assert level == "ERROR"
    assert text.endswith("Keeping the previous map.")
    send_map(at, [[100, 100]])
    assert at.statuses()["Map"][0] == "OK"
    assert at.poses()["tile 0 0"].position == pytest.approx((2.0, 0.0, 0.0))


@pytest.mark.parametrize("xyzw", [(0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 3.0)])
def test_an_orientation_of_another_length_is_put_right(
    at: DisplayBench, xyzw: tuple[float, float, float, float]
) -> None:
    send_map(at, [[0]], xyzw=xyzw)
    assert at.poses()["tile 0 0"].wxyz == pytest.approx((1.0, 0.0, 0.0, 0.0))


def test_changes_of_the_look_show_without_a_new_message(at: DisplayBench) -> None:
    send_map(at, [[0, 100]])
    at.set("alpha", 1.0)
    assert whole_picture(at).tolist() == [[[255, 255, 255, 255], [0, 0, 0, 255]]]
    at.set("color_scheme", "costmap")
    assert whole_picture(at).tolist() == [[[0, 0, 0, 0], [255, 0, 255, 255]]]
    at.set("binary_representation", True)
    assert whole_picture(at).tolist() == [[[0, 0, 255, 255], [255, 0, 0, 255]]]
    at.set("binary_threshold", 0)
    assert whole_picture(at).tolist() == [[[255, 0, 0, 255], [255, 0, 0, 255]]]
    at.set("draw_behind", True)
    assert at.nodes()["tile 0 0"].layer < -1000
    at.runner.order = 7
    at.set("draw_behind", False)
    assert at.nodes()["tile 0 0"].layer == 7


def test_an_invisible_map_is_not_called_ok(bench: Benches) -> None:
    at = bench(Map(alpha=0.0))
    send_map(at, [[0]])
    assert at.statuses()["Map"][0] == "WARN"


class TestCostmap(BuiltInChecks):
    display = Costmap
    scene = costmaps


class TestMap(BuiltInChecks):
    display = Map
    scene = maps
    variants = (
        Map,
        lambda: Map(use_timestamp=True, color_scheme="costmap"),
    )


def test_selecting_cell_of_a_map(at: DisplayBench) -> None:
    """The cell is in the second tile of a turned map."""
    cells = np.zeros((3, 600), np.int8)
    cells[1, 520] = 100
    info = {
        "resolution": 0.5,
        "width": 600,
        "height": 3,
        "origin": {"position": {"x": 10.0}, "orientation": {"z": QUARTER[2], "w": QUARTER[3]}},
    }
    at.send("nav_msgs/msg/OccupancyGrid", {"info": info, "data": cells.ravel()}, frame="map")
    at.turn()
    check_details(
        at.pick("tile 0 512", None, (0.5 * (520 - 512) + 0.1, 0.6, 0.0)),
        "Cell 520, 1",
        {
            "Value": "100, occupied",
            "Column (x)": "520",
            "Row (y)": "1",
            "Index": "1120",
            "Centre in map": "9.2500, 260.2500, 0.0000 m",
        },
    )


def test_selecting_cell_of_a_costmap(bench: Benches) -> None:
    at = bench(Costmap())
    at.send("nav2_msgs/msg/Costmap", COSTMAP, frame="map", topic="/local_costmap/costmap_raw")
    at.turn()
    check_details(at.pick("tile 0 0", None, (0.6, 0.6, 0.0)), "Cell 1, 1", {"Value": "254, lethal"})
