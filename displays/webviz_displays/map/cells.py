"""Details of one cell of a map."""

from __future__ import annotations

from collections.abc import Callable
from math import floor

from webviz import Details, Pose, compose
from webviz_displays.map.palettes import Scheme
from webviz_displays.map.tiles import Corner, TiledGrid

MEANINGS: dict[Scheme, dict[int, str]] = {
    "map": {-1: "unknown", 0: "free", 100: "occupied"},
    "costmap": {-1: "unknown", 0: "free", 99: "inscribed", 100: "lethal"},
    "raw": {},
}
"""Of values with a meaning, by scheme."""


def tile_key(corner: Corner) -> str:
    """Return the key of a tile's node."""
    row, column = corner
    return f"tile {row} {column}"


def cell_details(
    grid: TiledGrid,
    corner: Corner,
    point: tuple[float, float, float],
    told: Callable[[int], str | int],
) -> Details | None:
    """Return the cell at a point, None if there is none.

    Args:
        grid: the map.
        corner: of the tile.
        point: in metres from this corner, along rows and columns.
        told: what is said about a value.
    """
    cells, size = grid.tiles[corner], grid.resolution
    y, x = floor(point[1] / size), floor(point[0] / size)
    if not (0 <= y < cells.shape[0] and 0 <= x < cells.shape[1]):
        return None
    row, column = corner[0] + y, corner[1] + x
    center = compose(grid.origin, Pose(((column + 0.5) * size, (row + 0.5) * size, 0.0))).position
    return Details(
        f"Cell {column}, {row}",
        {
            "Value": told(int(cells[y, x])),
            "Column (x)": column,
            "Row (y)": row,
            "Index": row * grid.width + column,
            f"Centre in {grid.frame}": f"{center[0]:.4f}, {center[1]:.4f}, {center[2]:.4f} m",
            "Resolution": f"{size:.4g} m",
        },
    )
