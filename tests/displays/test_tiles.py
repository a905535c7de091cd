"""Occupancy grids in tiles, and updates folded into them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from webviz.data.messages import (
    MapMetaData,
    OccupancyGrid,
    OccupancyGridUpdate,
    Point,
    Pose,
    Quaternion,
)
from webviz_displays.map.tiles import GridFault, tiled, updated


def map_message(cells: np.ndarray) -> OccupancyGrid:
    height, width = cells.shape
    origin = Pose(Point(1.0, 2.0, 0.0), Quaternion())
    return OccupancyGrid(
        info=MapMetaData(resolution=0.1, width=width, height=height, origin=origin),
        data=cells.ravel(),
    )


Cells = NDArray[np.int8]


def cells_of(width: int, height: int) -> st.SearchStrategy[Cells]:
    """Few rows or columns keep the examples small, and still cross the borders of tiles."""
    return st.integers(0, 2**32 - 1).map(
        lambda seed: (
            np.random.default_rng(seed).integers(-128, 128, (height, width)).astype(np.int8)
        )
    )


@st.composite
def maps_with_updates(draw: st.DrawFn) -> tuple[Cells, list[tuple[int, int, Cells]]]:
    width, height = draw(st.sampled_from([(1, 1), (512, 3), (1200, 2), (3, 1025), (513, 513)]))
    cells = draw(cells_of(width, height))
    updates = []
    for _ in range(draw(st.integers(0, 4))):
        x, y = draw(st.integers(0, width - 1)), draw(st.integers(0, height - 1))
        w, h = draw(st.integers(0, width - x)), draw(st.integers(0, height - y))
        updates.append((x, y, draw(cells_of(w, h))))
    return cells, updates


@given(maps_with_updates())
def test_folding_updates_gives_the_tiles_of_the_whole_map(
    case: tuple[Cells, list[tuple[int, int, Cells]]],
) -> None:
    cells, updates = case
    grid = tiled(map_message(cells), "map")
    whole = cells.copy()
    for x, y, part in updates:
        height, width = part.shape
        message = OccupancyGridUpdate(x=x, y=y, width=width, height=height, data=part.ravel())
        before = {corner: tile.copy() for corner, tile in grid.tiles.items()}
        older = grid
        grid = updated(grid, message, "map")
        assert all((older.tiles[corner] == tile).all() for corner, tile in before.items())
        whole[y : y + height, x : x + width] = part
    expected = tiled(map_message(whole), "map")
    assert grid.tiles.keys() == expected.tiles.keys()
    for corner, tile in expected.tiles.items():
        assert (grid.tiles[corner] == tile).all()


def test_an_update_that_changes_no_cell_keeps_every_tile() -> None:
    cells = np.arange(12, dtype=np.int8).reshape(3, 4)
    grid = tiled(map_message(cells), "map")
    message = OccupancyGridUpdate(x=1, y=1, width=2, height=2, data=cells[1:3, 1:3].ravel())
    assert updated(grid, message, "map").tiles[0, 0] is grid.tiles[0, 0]


def test_a_refused_update_is_an_error_that_a_caller_can_catch() -> None:
    grid = tiled(map_message(np.zeros((2, 2), np.int8)), "map")
    with pytest.raises(GridFault, match="outside"):
        updated(
            grid, OccupancyGridUpdate(x=2, y=0, width=1, height=1, data=np.ones(1, np.int8)), "map"
        )
