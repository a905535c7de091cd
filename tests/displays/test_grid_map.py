"""The GridMap display."""

from __future__ import annotations

import copy
import math
import struct
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from grid_maps import GRID_MAP, grid_map
from inspecting import Benches
from mapping_scenes import terrain
from plain_scenes import in_moving_frame

from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.grid_map import GridMap
from webviz_displays.grid_map import display as display_module
from webviz_displays.grid_map.display import faces_of

NAN = math.nan


def corners(at: DisplayBench) -> dict[tuple[float, float, float], tuple[int, int, int]]:
    """The colours of the corners of the surface, by their places in the fixed frame."""
    xyz, colors = at.xyz("surface"), at.nodes()["surface"].colors[:, :3]
    return {
        tuple(place): tuple(color)
        for place, color in zip(xyz.round(4).tolist(), colors.tolist(), strict=True)
    }


def slope(x: float, y: float) -> float:
    return 10.0 * x + y


@pytest.mark.parametrize("start", [(0, 0), (2, 3), (1, 0)])
def test_cells_have_their_position_and_the_height_of_their_layer(
    display_bench: Callable, start: tuple[int, int]
) -> None:
    values = grid_map({"elevation": slope}, (3, 4), 0.5, start, (1.0, 2.0))
    at = display_bench(GridMap(), values)
    places = corners(at)
    assert len(places) == 12
    for x, y, z in places:
        assert z == pytest.approx(slope(x - 10.0, y))
    xyz = np.array(list(places))
    np.testing.assert_allclose(xyz[:, :2].min(axis=0), (10.5, 1.25))
    np.testing.assert_allclose(xyz[:, :2].max(axis=0), (11.5, 2.75))
    assert at.statuses()["Grid map"] == ("OK", "Showing 12 of 3 x 4 cells of 0.5 m.")
    assert at.statuses()["Layers"] == ("OK", "elevation.")


def test_rows_may_be_side_by_side(display_bench: Callable) -> None:
    values = grid_map({"elevation": slope})
    matrix = values["data"][0]
    matrix["data"] = np.reshape(matrix["data"], (4, 3)).T.ravel().tolist()
    matrix["layout"]["dim"] = matrix["layout"]["dim"][::-1]
    assert corners(display_bench(GridMap(), values)) == corners(
        display_bench(GridMap(), grid_map({"elevation": slope}))
    )


def test_a_surface_faces_up_and_leaves_holes_open() -> None:
    """Three of four neighbours make a triangle, four make two."""
    # Rows are along -x, columns along -y.
    xyz = np.array([[(1.0, 1.0, 0.0), (1.0, 0.0, 0.0)], [(0.0, 1.0, 0.0), (0.0, 0.0, 0.0)]])
    for pattern in range(16):
        is_valid = np.array([pattern >> bit & 1 for bit in range(4)], bool).reshape(2, 2)
        faces = faces_of(is_valid)
        assert len(faces) == max(0, int(is_valid.sum()) - 2)
        a, b, c = np.moveaxis(xyz[is_valid][faces], 1, 0)
        assert (np.cross(b - a, c - a)[:, 2] > 0).all()


def test_cells_without_a_value_are_holes(display_bench: Callable) -> None:
    layers = {
        "elevation": lambda x, y: NAN if x > 0.4 and y > 0.7 else 0.0,
        "variance": lambda x, y: math.inf if x < -0.4 and y < -0.7 else 1.0,
        "color": lambda x, y: NAN,
    }
    at = display_bench(GridMap(color_layer="variance"), grid_map(layers))
    assert len(corners(at)) == 11
    assert corners(at)[9.5, -0.75, 0.0] == display_module.NO_VALUE
    at.send(GRID_MAP, grid_map(layers, basic=["variance", "no such layer"]), frame="odom")
    at.turn()
    assert len(corners(at)) == 10
    at.send(GRID_MAP, grid_map({"elevation": lambda x, y: NAN}), frame="odom")
    at.set("color_layer", "elevation")
    assert at.nodes() == {}
    assert at.statuses()["Grid map"][0] == "WARN"


def test_colors_are_by_a_layer_packed_or_flat(display_bench: Callable) -> None:
    packed = struct.unpack("<f", struct.pack("<I", 0x0A141E))[0]
    layers = {"elevation": lambda x, y: x, "rgb": lambda x, y: packed}
    at = display_bench(GridMap(), grid_map(layers))
    low, high = (9.5, -0.75, -0.5), (10.5, -0.75, 0.5)
    assert (corners(at)[low], corners(at)[high]) == ((255, 0, 255), (255, 0, 0))
    at.set("invert_rainbow", True)
    assert (corners(at)[low], corners(at)[high]) == ((255, 0, 0), (255, 0, 255))
    at.set("use_rainbow", False)
    at.set("autocompute_intensity_bounds", False)
    at.set("max_intensity", 1.0)
    assert (corners(at)[low], corners(at)[high]) == ((0, 0, 0), (128, 128, 128))
    at.set("color_layer", "rgb")
    at.set("color_transformer", "ColorLayer")
    assert set(corners(at).values()) == {(10, 20, 30)}
    at.set("color_transformer", "FlatColor")
    assert set(corners(at).values()) == {(200, 200, 200)}
    at.set("height_transformer", "Flat")
    assert {z for _, _, z in corners(at)} == {0.0}
    at.set("color_transformer", "None")
    assert set(at.nodes()) == {"lines"}
    at.set("show_grid_lines", False)
    assert at.statuses()["Grid map"][0] == "WARN"


def test_lines_follow_rows_and_columns(display_bench: Callable) -> None:
    at = display_bench(GridMap(), grid_map({"elevation": slope}, (5, 6)))
    node = at.nodes()["lines"]
    assert (len(node.segments), node.width, node.unit) == (5 * 5 + 6 * 4, 0.05, "m")
    at.set("grid_cell_decimation", 3)
    assert len(at.nodes()["lines"].segments) == 3 * 5 + 3 * 4


def test_former_maps_stay(display_bench: Callable) -> None:
    values = grid_map({"elevation": slope})
    at = display_bench(GridMap(history_length=2), values, values, values)
    assert sum(key.startswith("surface") for key, _, _ in at.scene.visible()) == 2


def test_a_large_map_is_thinned_out(
    display_bench: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(display_module, "MAX_CELLS", 30)
    at = display_bench(GridMap(), grid_map({"elevation": slope}, (10, 10)))
    assert len(corners(at)) == 25
    assert at.statuses()["Grid map"][0] == "WARN"
    for x, y, z in corners(at):
        assert z == pytest.approx(slope(x - 10.0, y))


WHOLE = grid_map({"elevation": slope, "variance": slope})


def broken(change: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
    values = copy.deepcopy(WHOLE)
    change(values)
    return values


FAULTS = {
    "no layers": (broken(lambda v: v.update(layers=[], data=[])), "has 0 layers"),
    "too few": (broken(lambda v: v["data"].pop()), "2 layers and 1 matrices"),
    "another layer": (grid_map({"height": slope}), "no layer 'elevation', but 'height'"),
    "no dimensions": (broken(lambda v: v["data"][0].pop("layout")), "12 values for the dim"),
    "too short": (broken(lambda v: v["data"][0]["data"].pop()), "11 values for the dimensions"),
    "one row": (grid_map({"elevation": slope}, (1, 4)), "has 1 rows and 4 columns"),
    "no size": (grid_map({"elevation": slope}, resolution=0.0), "resolution of the grid map is 0"),
    "far": (grid_map({"elevation": lambda x, y: 0.0}, center=(1e30, 0.0)), "pose of the grid map"),
}


def test_a_missing_layer_is_replaced_by_the_most_similar_one(display_bench: Callable) -> None:
    layers = {"variance": slope, "elevation_raw": slope}
    at = display_bench(GridMap(color_layer="colour"), grid_map(layers))
    remedy = at.remedy("Grid map")
    assert (remedy.path, remedy.label) == ("height_layer", "Use elevation_raw")
    at.set(remedy.path, remedy.value)
    assert "no layer 'colour'" in at.statuses()["Grid map"][1]
    at.press("Grid map")
    assert at.nodes()


@pytest.mark.parametrize("case", FAULTS)
def test_an_invalid_map_has_a_status(display_bench: Callable, case: str) -> None:
    values, reason = FAULTS[case]
    at = display_bench(GridMap(), values)
    assert at.nodes() == {}
    level, text = at.statuses()["Grid map"]
    assert level == "ERROR"
    assert reason in text


def test_a_layer_of_another_size_is_an_error(display_bench: Callable) -> None:
    smaller = grid_map({"elevation": slope}, (2, 2))["data"][0]
    at = display_bench(
        GridMap(color_layer="variance"), broken(lambda v: v["data"].__setitem__(1, smaller))
    )
    level, text = at.statuses()["Grid map"]
    assert level == "ERROR"
    assert text.startswith("The layer 'variance' has 2 rows and 2 columns, the first one 3 rows")


class TestGridMap(BuiltInChecks):
    display = GridMap
    scene = in_moving_frame(GRID_MAP, terrain(), terrain())
    variants = (
        GridMap,
        lambda: GridMap(height_transformer="Flat", color_transformer="ColorLayer"),
    )


def test_selecting_cell_of_a_grid_map(turned: Benches) -> None:
    """Rows are along -x."""
    layers = {"elevation": lambda x, y: x, "variance": lambda x, y: 0.25}
    values = grid_map(layers, (3, 4), 0.5, (1, 2))
    check_details(
        turned(GridMap(), values).pick("surface", None, (0.4, -0.7, 0.5)),
        "Cell 0, 3",
        {"elevation": "0.5", "variance": "0.25", "Size of a cell": "0.5 m"},
    )
