"""The displays of Nav2's voxel grids and costmaps."""

from __future__ import annotations

import math
from collections.abc import Callable, Set
from itertools import product
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from mapping_scenes import VOXEL_GRID
from plain_scenes import in_moving_frame

from webviz.shell.testing import check_details
from webviz_displays import voxel_grid as voxel_grid_module
from webviz_displays.map import Costmap
from webviz_displays.map.palettes import lookup_table
from webviz_displays.voxel_grid import VoxelGrid

Key = tuple[int, int, int]
COSTMAP, UPDATE = "nav2_msgs/msg/Costmap", "nav2_msgs/msg/CostmapUpdate"


def voxel_grid(
    shape: Key, marked: set[Key], unknown: Set[Key] = frozenset(), **fields: Any
) -> dict[str, Any]:
    """A message: all other voxels are free."""
    columns = [0] * (shape[0] * shape[1])
    for x, y, z in marked:
        columns[y * shape[0] + x] |= 1 << (z + 16) | 1 << z
    for x, y, z in unknown:
        columns[y * shape[0] + x] |= 1 << z
    return {
        "data": columns,
        "origin": {"x": 1.0, "y": 2.0, "z": 0.0},
        "resolutions": {"x": 0.5, "y": 0.5, "z": 0.25},
        "size_x": shape[0],
        "size_y": shape[1],
        "size_z": shape[2],
    } | fields


def test_each_kind_of_voxel_has_its_boxes(turned: Callable) -> None:
    values = voxel_grid((3, 2, 16), {(0, 0, 0), (2, 1, 15)}, {(1, 0, 4)})
    at = turned(VoxelGrid(show_unknown=True, show_free=True), values)
    nodes = at.nodes()
    assert {key: len(node.positions) for key, node in nodes.items()} == {
        "marked": 2,
        "unknown": 1,
        "free": 3 * 2 * 16 - 3,
    }
    assert nodes["marked"].colors == (255, 0, 0)
    assert (nodes["unknown"].colors, nodes["unknown"].opacity) == ((0, 0, 255), 0.5)
    np.testing.assert_allclose(nodes["marked"].scales, [(0.5, 0.5, 0.25)] * 2)
    # 1.25, 2.25 and 2.25, 2.75 in odom.
    expected = [(10 - 2.25, 1.25, 0.125), (10 - 2.75, 2.25, 15.5 * 0.25)]
    np.testing.assert_allclose(at.xyz("marked"), expected, atol=1e-6)
    assert at.statuses()["Voxels"] == (
        "OK",
        "2 marked, 1 unknown, 93 free, of 0.5 m x 0.5 m x 0.25 m.",
    )
    at.set("show_unknown", False)
    at.set("show_free", False)
    at.set("marked_alpha", 0.0)
    assert at.nodes() == {}
    assert at.statuses()["Voxels"][0] == "WARN"
    at.press("Voxels")
    assert at.nodes()


def test_voxels_inside_others_are_not_sent(turned: Callable) -> None:
    block = set(product(range(1, 5), range(1, 5), range(4)))
    at = turned(VoxelGrid(), voxel_grid((6, 6, 4), block))
    assert len(at.nodes()["marked"].positions) == 4**3 - 2**3


def test_too_many_voxels_are_thinned_out(turned: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(voxel_grid_module, "MAX_VOXELS", 5)
    at = turned(VoxelGrid(), voxel_grid((3, 3, 1), set(product(range(3), range(3), [0]))))
    assert len(at.nodes()["marked"].positions) == 5
    assert at.statuses()["Limit"][0] == "WARN"


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"data": [0] * 5}, "3 x 2 columns, but the data has 5"),
        ({"size_z": 17}, "3 x 2 x 17 voxels"),
        ({"size_z": 0}, "3 x 2 x 0 voxels"),
        ({"resolutions": {"x": 0.5, "y": 0.0, "z": 0.25}}, "0.5 m x 0 m x 0.25 m"),
        ({"resolutions": {"x": 0.5, "y": math.nan, "z": 0.25}}, "0.5 m x nan m x 0.25 m"),
        ({"origin": {"x": math.inf}}, "The origin is not finite"),
    ],
)
def test_an_invalid_grid_has_a_status(
    turned: Callable, fields: dict[str, Any], reason: str
) -> None:
    at = turned(VoxelGrid(), voxel_grid((3, 2, 4), {(0, 0, 0)}, **fields))
    assert at.nodes() == {}
    level, text = at.statuses()["Voxels"]
    assert level == "ERROR"
    assert reason in text


def test_costs_have_the_colors_of_their_occupancies(bench: Benches) -> None:
    """The values that Nav2 publishes for the same cells as an occupancy grid."""
    costmap = Costmap(alpha=1.0)
    at = bench(costmap)
    costs = [0, 1, 128, 252, 253, 254, 255, 0]
    metadata = {"size_x": 4, "size_y": 2, "resolution": 0.05, "origin": {"orientation": {"w": 1.0}}}
    values, topic = {"metadata": metadata, "data": costs}, costmap.topic.name
    at.send(COSTMAP, values, frame="map", topic=topic)
    at.turn()
    table = lookup_table("costmap")
    occupancies = np.array([0, 1, 50, 98, 99, 100, 255, 0])
    tile = at.nodes()["tile 0 0"]
    assert tile.rgba.reshape(-1, 4).tolist() == table[occupancies].tolist()
    assert (tile.width, tile.height) == (pytest.approx(0.2), pytest.approx(0.1))
    at.set("color_scheme", "raw")
    assert at.nodes()["tile 0 0"].rgba.reshape(-1, 4)[:, 0].tolist() == costs
    update = {"x": 3, "y": 1, "size_x": 1, "size_y": 1, "data": [200]}
    at.send(UPDATE, update, frame="map", topic=f"{topic}_updates")
    at.turn()
    assert at.nodes()["tile 0 0"].rgba[1, 3].tolist() == [200, 200, 200, 255]
    assert at.statuses()["Map"][0] == "OK"


class TestVoxelGrid(BuiltInChecks):
    display = VoxelGrid
    scene = in_moving_frame("nav2_msgs/msg/VoxelGrid", VOXEL_GRID)
    variants = (lambda: VoxelGrid(show_unknown=True, show_free=True),)


def test_selecting_voxel_of_a_costmap(turned: Benches) -> None:
    check_details(
        turned(VoxelGrid(), VOXEL_GRID).pick("marked", 1),
        "Voxel 0, 0, 1",
        {"State": "marked"},
    )
