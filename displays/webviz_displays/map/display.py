"""Occupancy grids: maps and costmaps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import floor
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from webviz import (
    Comparable,
    Context,
    Details,
    Display,
    Frames,
    Hit,
    Image,
    Input,
    Level,
    Lookback,
    Measurement,
    OtherFixedFrame,
    Pose,
    Prop,
    Remedy,
    Sample,
    SelfPlacing,
    Status,
    Topic,
    compose,
)
from webviz.api.consistency import OccupiedCells
from webviz.data.words import counted, joined
from webviz_displays.map.palettes import Scheme, lookup_table
from webviz_displays.map.tiles import Corner, GridFault, TiledGrid, tiled, updated, window
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.properties import opaque

MEANINGS: dict[Scheme, dict[int, str]] = {
    "map": {-1: "unknown", 0: "free", 100: "occupied"},
    "costmap": {-1: "unknown", 0: "free", 99: "inscribed", 100: "lethal"},
    "raw": {},
}
"""Meanings of values with a meaning, by scheme."""


def tile_key(corner: Corner) -> str:
    """Return the key of a tile's node."""
    row, column = corner
    return f"tile {row} {column}"


def cell_details(
    grid: TiledGrid,
    corner: Corner,
    point: tuple[float, float, float],
    text_of: Callable[[int], str | int],
) -> Details | None:
    """Return the cell at a point, None if there is none.

    Args:
        grid: the map.
        corner: of the tile.
        point: in metres from this corner, along rows and columns.
        text_of: what is said about a value.
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
            "Value": text_of(int(cells[y, x])),
            "Column (x)": column,
            "Row (y)": row,
            "Index": row * grid.width + column,
            f"Centre in {grid.frame}": f"{center[0]:.4f}, {center[1]:.4f}, {center[2]:.4f} m",
            "Resolution": f"{size:.4g} m",
        },
    )


OPAQUE = 0.9998
"""An alpha from here on counts as 1, as in RViz."""

UNKNOWN = -1
"""Value of a cell of which nothing is known."""
BEHIND = 100_000
"""Layers that `draw_behind` lowers a map by: more than any config has displays."""


class MapStyle(msgspec.Struct, frozen=True):
    """Mapping from the cells of a tile to a picture.

    Args:
        table: RGBA by cell value, uint8 (256, 4).
        resolution: metres per cell.
        layer: of the picture.
    """

    table: NDArray[np.uint8]
    resolution: float
    layer: int

    def is_like(self, other: MapStyle | None) -> bool:
        """Return whether equal cells look alike; tables are cached, so identity is enough."""
        if other is None or self.table is not other.table:
            return False
        return (self.resolution, self.layer) == (other.resolution, other.layer)


class Folded(msgspec.Struct, frozen=True):
    """A map with all its updates.

    Args:
        grid: the last map that could be drawn, if any.
        stamp_ns: of that map.
        fault: why a newer map could not be drawn.
        remedy: of that.
        updates: how many changed the grid.
        update_fault: why the last update was refused.
        placed: the pose that the frame of the map had at its stamp, by fixed frame; the last one.
    """

    grid: TiledGrid | None
    stamp_ns: int = 0
    fault: str = ""
    remedy: Remedy | None = None
    updates: int = 0
    update_fault: str = ""
    placed: dict[str, Pose] = msgspec.field(default_factory=dict)


Tile = tuple[NDArray[np.int8], Image]
"""The cells of a tile, and how they were drawn."""


class _State(msgspec.Struct):
    """State drawn last.

    Args:
        look: of all tiles.
        tiles: by corner.
        grid: whole.
    """

    look: MapStyle | None = None
    tiles: dict[Corner, Tile] = msgspec.field(default_factory=dict)
    grid: TiledGrid | None = None


class MapDisplay(Display, SelfPlacing):
    """Base of displays that draw a grid of cells as a flat picture."""

    is_threaded = True

    topic: Annotated[Topic, Prop(help="Topic of the maps.")] = Topic()
    update_topic: Annotated[
        Topic, Prop(help="Topic of partial updates; empty means the map's topic + _updates.")
    ] = Topic()
    alpha: Annotated[Alpha, Prop(help="Opacity of the map; 0 is invisible.")] = 0.7
    color_scheme: Annotated[
        Literal["map", "costmap", "raw"],
        Prop(
            help="map: white free, black occupied. costmap: blue to red with cyan and magenta at "
            "99 and 100. raw: the value as grey."
        ),
    ] = "map"
    draw_behind: Annotated[
        bool, Prop(help="Draw this map below all other maps, regardless of its place in the list.")
    ] = False
    use_timestamp: Annotated[
        bool,
        Prop(help="Keep the map where its frame was at the stamp, instead of following the frame."),
    ] = False
    binary_representation: Annotated[
        bool,
        Prop(rviz="Binary representation", help="Use two colours only, split at the threshold."),
    ] = False
    binary_threshold: Annotated[
        int,
        Prop(
            ge=0,
            le=100,
            rviz="Binary threshold",
            when=("binary_representation", True),
            help="Cells of this value and above count as occupied.",
        ),
    ] = 100

    def as_grid(self, name: str, message: Any) -> Any:
        """Return a message of the input `name` with the fields of an OccupancyGrid or its update.

        Raises:
            GridFault: it cannot be one; the text says why.
        """
        return message

    def table(self, alpha: float, threshold: int | None) -> NDArray[np.uint8]:
        """Return the colours of cells, cached; see `lookup_table`."""
        return lookup_table(self.color_scheme, alpha, threshold)

    def value_text(self, value: int) -> str | int:
        """Return the label of a cell's value, -128 to 127."""
        meaning = MEANINGS[self.color_scheme].get(value)
        return f"{value}, {meaning}" if meaning else value

    def new_state(self) -> _State:
        """Nothing drawn."""
        return _State()

    def waits(self, name: str) -> bool:
        """Return whether a transform is needed: not if the map follows its frame."""
        return self.use_timestamp and name == "topic"

    def lookback(self, name: str) -> Lookback:
        """Return the newest map, and its updates."""
        return Lookback(count=1) if name == "topic" else Lookback(since="topic")

    def fold(self, name: str, sample: Sample, state: Folded | None) -> Folded | None:
        """Take a new map, or update the current one."""
        grid = state.grid if state else None
        if name == "topic":
            try:
                message = self.as_grid(name, sample.message)
                return Folded(tiled(message, sample.frame, grid), sample.stamp_ns)
            except GridFault as fault:
                return replace(state or Folded(None), fault=str(fault), remedy=fault.remedy)
        if state is None or grid is None or state.fault:
            return state  # an update means nothing without the map it changes
        try:
            grid = updated(grid, self.as_grid(name, sample.message), sample.frame)
        except GridFault as fault:
            return replace(state, update_fault=str(fault))
        return replace(state, grid=grid, updates=state.updates + 1, update_fault="")

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the tiles; those whose cells and colours did not change keep their nodes."""
        if not samples:
            ctx.warn("Map", "No map received. Start the map server or choose another topic.")
            return
        folded: Folded = samples[-1].message
        grid = folded.grid
        ctx.state.grid = grid
        if grid is None:
            ctx.error("Map", folded.fault, folded.remedy)
            return
        threshold = self.binary_threshold if self.binary_representation else None
        alpha = 1.0 if self.alpha >= OPAQUE else self.alpha
        look = MapStyle(
            self.table(alpha, threshold),
            grid.resolution,
            ctx.order - (BEHIND if self.draw_behind else 0),
        )
        images = _images(grid, look, ctx.state)
        outer, frame = Pose(), grid.frame
        if self.use_timestamp and folded.stamp_ns:
            self.place(folded, ctx.frames)
            if at_stamp := folded.placed.get(ctx.frames.fixed_frame):
                outer, frame = at_stamp, None
            else:
                reason = ctx.frames.explain(grid.frame, folded.stamp_ns)
                text = joined(reason.sentence, "Until then the map follows its frame.")
                ctx.warn("Transform", text, OtherFixedFrame.of(reason), reason)
        group = ctx.follow(frame, when="now", offset=compose(outer, grid.origin))
        for (row, column), image in images.items():
            corner = (column * grid.resolution, row * grid.resolution, 0.0)
            group.add(tile_key((row, column)), image, Pose(corner))
        self._report(folded, grid, ctx)

    def places(self, name: str) -> bool:
        """Return whether the map stays where its frame was at its stamp."""
        return self.waits(name)

    def place(self, message: Folded, frames: Frames) -> None:
        """Keep where the frame was at the stamp, because transforms expire after seconds."""
        if not (self.use_timestamp and message.stamp_ns and message.grid):
            return
        if pose := frames.at(message.grid.frame, message.stamp_ns):
            message.placed.clear()
            message.placed[frames.fixed_frame] = pose

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a cell, with the value that it has now."""
        grid, corner = _tile(ctx.state, hit.key)
        return cell_details(grid, corner, hit.point, self.value_text) if grid and corner else None

    def _report(self, folded: Folded, grid: TiledGrid, ctx: Context) -> None:
        size = f"{grid.width} x {grid.height} cells of {grid.resolution:.4g} m"
        if folded.fault:
            ctx.error("Map", joined(folded.fault, "Keeping the previous map."), folded.remedy)
        elif self.alpha == 0:
            ctx.warn(
                "Map", f"{size}, invisible: alpha is 0. Increase it to show the map.", opaque()
            )
        elif not any((tile != UNKNOWN).any() for tile in grid.tiles.values()):
            text = f"{size}, all of which are unknown. Check the publisher of the map."
            nothing = Measurement("known cells", 0)
            ctx.statuses["Map"] = Status(Level.WARN, text, values=(nothing,))
        else:
            ctx.ok("Map", f"{size} in frame '{grid.frame}'.")
        if not grid.is_turned:
            ctx.ok("Orientation", "The rotation of the origin is all zeros, taken as none.")
        if folded.update_fault:
            ctx.error("Update", folded.update_fault)
        elif folded.updates:
            ctx.ok("Update", f"{counted(folded.updates, 'update')} since the last whole map.")


class Map(MapDisplay, Comparable):
    """An occupancy grid as a flat picture: free, occupied and unknown cells.

    A map that cannot be drawn is an error, and the previous map stays: a robot that drives by it
    is still seen on it.
    """

    rviz = "rviz_default_plugins/Map"
    icon = "map"

    topic: Annotated[
        Topic,
        Input("nav_msgs/msg/OccupancyGrid", is_sporadic=True),
        Prop(help="Topic of the maps."),
    ] = Topic("/map")
    update_topic: Annotated[
        Topic,
        Input(
            "map_msgs/msg/OccupancyGridUpdate", suffix="_updates", optional=True, is_sporadic=True
        ),
        Prop(help="Topic of partial updates; empty means the map's topic + _updates."),
    ] = Topic()

    def consistency_input(self, samples: Sequence[Sample], ctx: Context) -> OccupiedCells | None:
        """Return where the map has walls; costmaps have what a robot keeps away from."""
        grid: TiledGrid | None = samples[-1].message.grid if samples else None
        if grid is None or self.color_scheme != "map" or not self.alpha:
            return None
        return OccupiedCells(
            self.topic.name, grid.frame, grid.origin, grid.resolution, partial(window, grid)
        )


def _tile(state: _State, key: str) -> tuple[TiledGrid | None, Corner | None]:
    """Return the map that is drawn, and the corner of the tile whose node has a key."""
    grid = state.grid
    return grid, next((c for c in grid.tiles if tile_key(c) == key), None) if grid else None


def _images(grid: TiledGrid, look: MapStyle, state: _State) -> dict[Corner, Image]:
    """Return a node for each tile; unchanged tiles keep the node of the previous call."""
    before = state.tiles if look.is_like(state.look) else {}
    tiles: dict[Corner, Tile] = {}
    for corner, cells in grid.tiles.items():
        old = before.get(corner)
        if old is None or old[0] is not cells:
            rows, columns = cells.shape
            width, height = columns * grid.resolution, rows * grid.resolution
            image = Image(cells.view(np.uint8), width, height, look.layer, look.table)
            old = (cells, image)
        tiles[corner] = old
    state.look, state.tiles = look, tiles
    return {corner: image for corner, (_, image) in tiles.items()}
