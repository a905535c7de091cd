from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import robot_frame
from inspecting import Benches

from webviz.scene.schemes import SCHEMES
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.axes import Axes
from webviz_displays.grid import Grid


def grid(bench: Benches, **properties: Any) -> DisplayBench:
    at = bench(Grid(**properties))
    at.turn()
    return at


def test_the_default_grid_is_the_one_of_rviz(bench: Benches) -> None:
    grid_lines = grid(bench)
    node = grid_lines.nodes()["grid"]
    assert node.segments.shape == (22, 2, 3)  # 11 lines each way
    assert node.segments.min(axis=(0, 1)).tolist() == [-5, -5, 0]
    assert node.segments.max(axis=(0, 1)).tolist() == [5, 5, 0]
    assert (node.colors, node.opacity) == (None, 0.5)  # the grey of the theme
    assert SCHEMES["dark"]["grid"] == Grid().color == (160, 160, 164)
    assert (node.width, node.unit) == (1.0, "px")
    assert grid_lines.statuses()["Grid"][0] == "OK"


def test_a_small_grid_line_by_line(bench: Benches) -> None:
    grid_lines = grid(bench, plane_cell_count=1, cell_size=2.0, offset=(10.0, 0.0, 1.0))
    lines = {
        tuple(sorted(map(tuple, ends))) for ends in grid_lines.nodes()["grid"].segments.tolist()
    }
    assert lines == {
        ((9, -1, 1), (9, 1, 1)),
        ((11, -1, 1), (11, 1, 1)),
        ((9, -1, 1), (11, -1, 1)),
        ((9, 1, 1), (11, 1, 1)),
    }


def test_cells_along_the_normal_make_a_cage(bench: Benches) -> None:
    segments = grid(bench, plane_cell_count=1, normal_cell_count=2).nodes()["grid"].segments
    assert len(segments) == 3 * 4 + 4  # three layers, four posts
    posts = segments[np.abs(segments[:, 0, 2] - segments[:, 1, 2]) > 0]
    assert np.sort(posts[:, :, 2], axis=1).tolist() == [[-1, 1]] * 4
    assert sorted(np.unique(segments[..., 2])) == [-1, 0, 1]


@pytest.mark.parametrize(("plane", "flat"), [("XY", 2), ("XZ", 1), ("YZ", 0)])
def test_the_plane_can_be_chosen(bench: Benches, plane: str, flat: int) -> None:
    segments = grid(bench, plane=plane).nodes()["grid"].segments
    extent = np.ptp(segments, axis=(0, 1)).tolist()
    assert extent == [0 if axis == flat else 10 for axis in range(3)]


def test_billboards_have_a_width_in_metres(bench: Benches) -> None:
    node = grid(bench, line_style="Billboards", line_width=0.1).nodes()["grid"]
    assert (node.width, node.unit) == (0.1, "m")


@pytest.mark.parametrize(
    ("plane", "normal", "cells", "lines"),
    [
        (100_000, 0, "99998 x 99998", 199_998),
        (1_000_001, 0, "99999 x 99999", 200_000),
        (2000, 1, "444 x 444 x 1", 199_805),
        (1000, 100, "356 x 356 x 100", 199_563),
        (10, 1_000_000, "10 x 10 x 9084", 199_991),
        (10**400, 10**400, "", 0),
    ],
)
def test_a_grid_over_the_limit_draws_its_middle(
    bench: Benches, plane: int, normal: int, cells: str, lines: int
) -> None:
    grid_lines = grid(bench, plane_cell_count=plane, normal_cell_count=normal, cell_size=0.5)
    level, text = grid_lines.statuses()["Grid"]
    assert level == "WARN"
    assert f"showing the {cells}" in text
    segments = grid_lines.nodes()["grid"].segments
    if cells:
        assert len(segments) == lines
    assert 150_000 < len(segments) <= 200_000
    # The lines that stay are where the whole grid has them.
    assert set(np.unique(segments[:, 0, 0] % 0.5)) == {plane % 2 * 0.25}


@pytest.mark.parametrize("far", [{"cell_size": 1e308}, {"offset": (0.0, -1e308, 0.0)}])
def test_a_grid_that_reaches_too_far_is_not_drawn(bench: Benches, far: Any) -> None:
    grid_lines = grid(bench, **far)
    assert grid_lines.nodes() == {}
    level, text = grid_lines.statuses()["Grid"]
    assert (level, text[:16]) == ("ERROR", "The grid reaches")


@pytest.mark.parametrize(("cls", "key"), [(Grid, "grid"), (Axes, "axes")])
def test_it_follows_its_frame_at_the_latest_common_time(
    bench: Benches, cls: type, key: str
) -> None:
    at = bench(cls(reference_frame="robot"))
    at.turn()
    assert at.nodes() == {}
    level, text = at.statuses()["Transform"]
    assert level == "ERROR"
    assert "robot" in text
    at.transform("map", "robot", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    at.turn()
    assert at.poses()[key].position == (1, 0, 0)
    at.transform("map", "robot", (2.0, 0.0, 0.0), stamp_ns=at.now_ns + 1)
    at.turn()
    assert at.poses()[key].position == (2, 0, 0)
    assert "Transform" not in at.statuses()


@pytest.mark.parametrize(("cls", "key"), [(Grid, "grid"), (Axes, "axes")])
@pytest.mark.parametrize("name", ["<Fixed Frame>", ""])
def test_by_default_it_stands_in_the_fixed_frame(
    bench: Benches, cls: type, key: str, name: str
) -> None:
    at = bench(cls(reference_frame=name))
    at.turn()
    assert at.poses()[key].position == (0, 0, 0)


def test_axes_have_a_length_and_a_radius(bench: Benches) -> None:
    at = bench(Axes(length=2.0, radius=0.25))
    at.turn()
    node = at.nodes()["axes"]
    assert (node.length, node.radius) == (2.0, 0.25)
    assert node.positions.tolist() == [[0, 0, 0]]


@pytest.mark.parametrize("cells", [{"plane_cell_count": 10**6}, {"normal_cell_count": 10**6}])
def test_a_grid_of_too_many_lines_offers_those_that_are_shown(
    bench: Benches, cells: dict[str, int]
) -> None:
    grid_lines = grid(bench, **cells)
    assert grid_lines.statuses()["Grid"][0] == "WARN"
    before = len(grid_lines.nodes()["grid"].segments)
    grid_lines.press("Grid")
    assert len(grid_lines.nodes()["grid"].segments) == before


class TestAxes(BuiltInChecks):
    display = Axes
    scene = robot_frame


class TestGrid(BuiltInChecks):
    display = Grid
    scene = robot_frame


def test_selecting_grid(bench: Benches) -> None:
    at = bench(Grid(plane_cell_count=4, cell_size=0.5))
    at.turn()
    check_details(
        at.pick("grid", 3), "Grid", {"Cell size": "0.5 m", "Cells": "4 x 4", "Plane": "XY"}
    )


def test_selecting_axes(bench: Benches) -> None:
    at = bench(Axes(reference_frame="odom"))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    check_details(at.pick("axes", 0), "Axes of odom", {"Length": "1 m"})
