"""Polygon and GridCells."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from plain_scenes import in_moving_frame

from webviz.shell.testing import check_details
from webviz_displays.areas import GridCells, Polygon
from webviz_displays.areas import grid_cells as grid_cells_module

NAN = float("nan")
CELLS = "nav_msgs/msg/GridCells"


def polygon(*points: tuple[float, float, float]) -> dict[str, Any]:
    return {"polygon": {"points": np.array(points, np.float32).reshape(-1, 3)}}


def cells(*centers: tuple[float, float, float], size: tuple[float, float]) -> dict[str, Any]:
    points = np.array(centers, np.float64).reshape(-1, 3)
    return {"cell_width": size[0], "cell_height": size[1], "cells": points}


def test_a_polygon_is_a_closed_line(turned: Benches) -> None:
    at = turned(Polygon(), polygon((0, 0, 0), (1, 0, 0), (1, 2, 0)))
    expected = [
        [(10, 0, 0), (10, 1, 0)],
        [(10, 1, 0), (8, 1, 0)],
        [(8, 1, 0), (10, 0, 0)],
    ]
    np.testing.assert_allclose(at.xyz("outline"), expected, atol=1e-6)
    node = at.nodes()["outline"]
    assert (node.colors, node.width, node.unit) == ((25, 255, 0), 1.0, "px")
    assert at.statuses()["Polygon"] == ("OK", "Showing 3 points.")


@pytest.mark.parametrize(
    ("points", "level", "text"),
    [
        ([], "WARN", "The polygon has 0 points"),
        ([(1, 0, 0)], "WARN", "The polygon has 1 point;"),
        ([(1, 0, 0), (NAN, 0, 0)], "ERROR", "Point 1 of 2, (nan, 0, 0), is not finite"),
    ],
)
def test_an_invalid_polygon_has_a_status(
    turned: Benches, points: list[Any], level: str, text: str
) -> None:
    at = turned(Polygon(), polygon(*points))
    assert at.nodes() == {}
    statuses = at.statuses()["Polygon"]
    assert (statuses[0], statuses[1].startswith(text)) == (level, True)


def test_former_polygons_stay(turned: Benches) -> None:
    lines = [polygon((0, 0, 0), (x, 0, 0)) for x in (1.0, 2.0, 3.0)]
    at = turned(Polygon(history_length=2), *lines)
    spans = [np.ptp(node.segments, axis=(0, 1)).max() for node in at.nodes().values()]
    assert sorted(spans) == [2.0, 3.0]


def test_a_cell_is_a_flat_rectangle_around_its_center(turned: Benches) -> None:
    at = turned(GridCells(alpha=0.5), cells((1, 0, 0.25), (2, 0, 0.25), size=(0.5, 0.25)))
    node = at.nodes()["cells"]
    assert (node.color, node.opacity, len(node.faces)) == ((25, 255, 0), 0.5, 4)
    assert node.is_flat
    corners = at.xyz("cells").reshape(2, 4, 3)
    np.testing.assert_allclose(corners.mean(axis=1), [(10, 1, 0.25), (10, 2, 0.25)], atol=1e-6)
    # The width is along x of odom, which is y of map.
    np.testing.assert_allclose(np.ptp(corners, axis=1), [(0.25, 0.5, 0)] * 2, atol=1e-6)
    assert at.statuses()["Cells"] == ("OK", "Showing 2 cells of 0.5 m x 0.25 m.")


@pytest.mark.parametrize("size", [(0.0, 1.0), (1.0, -1.0), (NAN, 1.0), (1.0, math.inf)])
def test_cells_without_a_size_are_an_error(turned: Benches, size: tuple[float, float]) -> None:
    at = turned(GridCells(), cells((1, 0, 0), size=size))
    assert at.nodes() == {}
    assert at.statuses()["Cells"][0] == "ERROR"


def test_cells_that_are_not_drawn_are_counted(
    turned: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    at = turned(GridCells(), cells((NAN, 0, 0), (1, 0, 0), size=(1, 1)))
    assert len(at.nodes()["cells"].faces) == 2
    assert at.statuses()["Cells"][1].startswith("1 of 2 cells are not finite")
    at.send(CELLS, cells(size=(1, 1)), frame="odom")
    at.turn()
    assert at.statuses()["Cells"] == ("WARN", "The message has no cells. Check its publisher.")
    monkeypatch.setattr(grid_cells_module, "MAX_CELLS", 5)
    at.send(CELLS, cells(*((i, 0, 0) for i in range(50)), size=(1, 1)), frame="odom")
    at.turn()
    assert len(at.nodes()["cells"].faces) == 10
    assert at.statuses()["Cells"] == ("WARN", "Showing 5 of 50 cells, evenly picked.")


class TestGridCells(BuiltInChecks):
    display = GridCells
    scene = in_moving_frame(
        "nav_msgs/msg/GridCells",
        *({"cell_width": 0.1, "cell_height": 0.2, "cells": [{"x": x}]} for x in (0.0, 1.0)),
    )


class TestPolygon(BuiltInChecks):
    display = Polygon
    scene = in_moving_frame(
        "geometry_msgs/msg/PolygonStamped",
        *({"polygon": {"points": [{"x": x}, {"y": x}, {"z": x}]}} for x in (1.0, 2.0)),
    )


def test_selecting_last_side_of_a_polygon(turned: Benches) -> None:
    points = np.array([(0, 0, 0), (3, 0, 0), (3, 4, 0)], np.float32)
    values = {"polygon": {"points": points}}
    check_details(
        turned(Polygon(), values).pick("outline", 2),
        "Side 2",
        {"Length": "5 m", "Points in the polygon": "3"},
    )


def test_selecting_cell_of_a_grid(turned: Benches) -> None:
    cells = np.array([(math.nan, 0, 0), (0, 0, 0), (1, 0, 0)], np.float64)
    values = {"cell_width": 1.0, "cell_height": 0.5, "cells": cells}
    clicked = (1.25, 0.125, 0.0)
    check_details(
        turned(GridCells(), values).pick("cells", None, clicked),
        "Cell 2",
        {"Size": "1 m x 0.5 m", "Cells in the message": "3"},
    )
