"""An occupancy grid cut into tiles, so that an update touches only what it changes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isfinite
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from webviz import Pose, Remedy
from webviz.data.rotations import normalized
from webviz_displays.shared.geometry import FARTHEST

TILE = 512
"""Cells along the edges of a tile, unless there would be more than `MAX_TILES`."""
MAX_TILES = 128
"""Largest number of tiles of a map. Each tile is a picture, which takes the frame loop up to a
millisecond."""
LONGEST_TILE = 8192
"""Cells along the edge of a texture that every browser accepts."""
MAX_CELLS = MAX_TILES * LONGEST_TILE
"""Cells along the edge of a map."""

SMALLEST_CELL = 1e-6
"""Metres; smaller cells are a publisher's error and invisible."""

Corner = tuple[int, int]
"""Row and column of a tile's cell (0, 0) in the grid."""


class GridFault(ValueError):
    """A grid or update that cannot be drawn; the text says why.

    Args:
        text: a sentence with the cause.
        remedy: a change of the display that would help, None if none would.
    """

    def __init__(self, text: str, remedy: Remedy | None = None) -> None:
        super().__init__(text)
        self.remedy = remedy


class TiledGrid(msgspec.Struct, frozen=True, eq=False):
    """A whole occupancy grid.

    Args:
        frame: frame id that `origin` is given in.
        width, height: in cells.
        resolution: edge of a cell in metres.
        origin: of the corner of cell (0, 0).
        is_turned: whether the message has a rotation of the origin, not all zeros.
        tiles: int8 arrays of at most `tile_shape` cells, by corner. They are read-only, and
            a tile that a message leaves as it was stays the same object.
    """

    frame: str
    width: int
    height: int
    resolution: float
    origin: Pose
    tiles: Mapping[Corner, NDArray[np.int8]]
    is_turned: bool = True


def tiled(message: Any, frame: str, before: TiledGrid | None = None) -> TiledGrid:
    """Return a grid from a nav_msgs/msg/OccupancyGrid.

    Args:
        message: the grid.
        frame: its frame id.
        before: the previous grid, whose unchanged tiles are reused.

    Raises:
        GridFault: the message contradicts itself, or what it describes cannot be drawn.
    """
    info, data = message.info, message.data
    width, height = info.width, info.height
    if not width or not height:
        raise GridFault(
            f"The map has no cells: its size is {width} x {height}. Check the map server."
        )
    if len(data) != width * height:
        raise GridFault(
            f"The map's size is {width} x {height} = {width * height} cells, "
            f"but its data has {len(data)}. Fix the publisher."
        )
    if max(width, height) > MAX_CELLS:
        raise GridFault(
            f"The map's size is {width} x {height} cells; at most {MAX_CELLS} along an edge can "
            "be drawn."
        )
    if not (SMALLEST_CELL <= info.resolution < FARTHEST / max(width, height)):
        raise GridFault(
            f"The map's resolution is {info.resolution:.4g} m per cell; it must be at least "
            f"{SMALLEST_CELL:g} m, and the map smaller than {FARTHEST:g} m."
        )
    cells = data.reshape(height, width)
    tiles_before = before.tiles if before else {}
    tiles = {}
    rows, columns = shape = tile_shape(height, width)
    for row, column in _corners((0, height), (0, width), shape):
        tile = cells[row : row + rows, column : column + columns]
        old = tiles_before.get((row, column))
        # A copy: a view would keep the whole message alive.
        tiles[row, column] = old if old is not None and np.array_equal(old, tile) else tile.copy()
    q = info.origin.orientation
    is_turned = any((q.x, q.y, q.z, q.w))
    origin = _origin(info.origin)
    return TiledGrid(frame, width, height, info.resolution, origin, tiles, is_turned)


def updated(grid: TiledGrid, update: Any, frame: str) -> TiledGrid:
    """Return the grid after a map_msgs/msg/OccupancyGridUpdate in the frame `frame`.

    Raises:
        GridFault: the update does not fit; the grid stays as it is.
    """
    x, y, width, height = update.x, update.y, update.width, update.height
    data = update.data
    if len(data) != width * height:
        raise GridFault(
            f"The update's size is {width} x {height} = {width * height} cells, "
            f"but its data has {len(data)}. Fix the publisher."
        )
    if x < 0 or y < 0 or x + width > grid.width or y + height > grid.height:
        raise GridFault(
            f"The update of {width} x {height} cells at ({x}, {y}) reaches outside of the map of "
            f"{grid.width} x {grid.height}."
        )
    if frame != grid.frame:
        raise GridFault(f"The update is in frame '{frame}', the map in '{grid.frame}'.")
    cells = data.reshape(height, width)
    tiles = dict(grid.tiles)
    shape = tile_shape(grid.height, grid.width)
    for row, column in _corners((y, y + height), (x, x + width), shape):
        old = tiles[row, column]
        top, left = max(y, row), max(x, column)
        bottom = min(y + height, row + old.shape[0])
        right = min(x + width, column + old.shape[1])
        part = cells[top - y : bottom - y, left - x : right - x]
        place = np.s_[top - row : bottom - row, left - column : right - column]
        if not np.array_equal(old[place], part):
            tiles[row, column] = old.copy()
            tiles[row, column][place] = part
    return replace(grid, tiles=tiles)


def window(grid: TiledGrid, row: int, column: int, rows: int, columns: int) -> NDArray[np.int8]:
    """Return the cells from a row and column on, which may lie outside; cells there are -1."""
    cells = np.full((rows, columns), -1, np.int8)
    for (top, left), tile in grid.tiles.items():
        up, down = max(top, row), min(top + tile.shape[0], row + rows)
        west, east = max(left, column), min(left + tile.shape[1], column + columns)
        if up < down and west < east:
            part = tile[up - top : down - top, west - left : east - left]
            cells[up - row : down - row, west - column : east - column] = part
    return cells


def tile_shape(height: int, width: int) -> tuple[int, int]:
    """Rows and columns of the tiles of a map, so that it has at most `MAX_TILES`.

    Larger maps have larger tiles; long ones have long tiles.
    """
    rows, columns = min(TILE, height), min(TILE, width)
    while -(-height // rows) * -(-width // columns) > MAX_TILES:
        if rows >= height or (columns <= rows and columns < width):
            columns *= 2
        else:
            rows *= 2
    return rows, columns


def _corners(
    rows: tuple[int, int], columns: tuple[int, int], shape: tuple[int, int]
) -> Iterator[Corner]:
    """Yield the tiles that touch the cells from the first to before the last row and column."""
    if rows[0] == rows[1] or columns[0] == columns[1]:
        return
    for row in range(rows[0] // shape[0] * shape[0], rows[1], shape[0]):
        for column in range(columns[0] // shape[1] * shape[1], columns[1], shape[1]):
            yield row, column


def _origin(pose: Any) -> Pose:
    """Return a geometry_msgs/msg/Pose.

    An all-zero orientation counts as the identity, as in RViz.
    """
    p, q = pose.position, pose.orientation
    position, wxyz = (p.x, p.y, p.z), (q.w, q.x, q.y, q.z)
    if not all(map(isfinite, (*position, *wxyz))):
        raise GridFault("The map's origin is not finite. Fix it in the map's file.")
    if max(map(abs, position)) >= FARTHEST:
        x, y, z = position
        raise GridFault(
            f"The map's origin is ({x:g}, {y:g}, {z:g}); it must be within {FARTHEST:g} m."
        )
    (unit,), _ = normalized([wxyz])
    return Pose(position, tuple(unit.tolist()))  # pyright: ignore[reportArgumentType]
