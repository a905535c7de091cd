"""Occupancy grids: maps and costmaps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from webviz import Context, Display, Image, Input, Pose, Prop, Sample, Topic
from webviz_displays.geometry import multiply, transformed
from webviz_displays.palettes import colorize, lookup_table
from webviz_displays.tiles import Corner, GridFault, TiledGrid, tiled, updated

OPAQUE = 0.9998
"""An alpha from here on counts as 1, as in RViz."""

BEHIND = -0.01
"""Metres that `draw_behind` lowers a map by."""


@dataclass(frozen=True)
class Folded:
    """A map with all its updates.

    Args:
        grid: None if the last map could not be drawn.
        fault: what is wrong with the last map.
        updates: how many changed the grid.
        update_fault: what is wrong with the last update.
    """

    grid: TiledGrid | None
    fault: str = ""
    updates: int = 0
    update_fault: str = ""


class Map(Display):
    """An occupancy grid as a flat picture: free, occupied and unknown cells."""

    rviz = "rviz_default_plugins/Map"

    topic: Annotated[Topic, Input("nav_msgs/msg/OccupancyGrid"), Prop(help="Whole maps.")] = Topic(
        "/map"
    )
    update_topic: Annotated[
        Topic,
        Input("map_msgs/msg/OccupancyGridUpdate", suffix="_updates", optional=True),
        Prop(help="Rectangles of cells that change the map; empty is the map's topic + _updates."),
    ] = Topic()
    alpha: Annotated[
        float,
        Prop(ge=0, le=1, widget="slider", help="Opacity of the map, 0 is invisible."),
    ] = 0.7
    color_scheme: Annotated[
        Literal["map", "costmap", "raw"],
        Prop(
            help="map: white free, black occupied. costmap: blue to red with cyan and magenta at "
            "99 and 100. raw: the value as grey."
        ),
    ] = "map"
    draw_behind: Annotated[
        bool, Prop(help="Lie a centimetre lower, behind other maps in the same plane.")
    ] = False
    use_timestamp: Annotated[
        bool,
        Prop(help="Stay where the map's frame was at its stamp, instead of following the frame."),
    ] = False
    binary_representation: Annotated[
        bool,
        Prop(rviz="Binary representation", help="Two colours only, split at the threshold."),
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

    def waits(self, name: str) -> bool:
        """A map that follows its frame needs no transform at its stamp, often long ago."""
        return self.use_timestamp

    def fold(self, name: str, sample: Sample, state: Folded | None) -> Folded | None:
        """Take a new map, or change the one there is."""
        grid = state.grid if state else None
        if name == "topic":
            try:
                return Folded(tiled(sample.message, sample.frame, grid))
            except GridFault as fault:
                return Folded(None, str(fault))
        if state is None or grid is None:
            return state  # an update says nothing without the map it changes
        try:
            grid = updated(grid, sample.message, sample.frame)
        except GridFault as fault:
            return Folded(grid, "", state.updates, str(fault))
        return Folded(grid, "", state.updates + 1)

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the tiles; those whose cells and colours did not change keep their nodes."""
        if not samples:
            ctx.warn("Map", "No map received.")
            return
        folded: Folded = samples[-1].message
        grid = folded.grid
        if grid is None:
            ctx.error("Map", folded.fault)
            return
        threshold = self.binary_threshold if self.binary_representation else None
        alpha = 1.0 if self.alpha >= OPAQUE else self.alpha
        images = _images(grid, lookup_table(self.color_scheme, alpha, threshold), ctx.state)
        outer, frame = Pose(), grid.frame
        if self.use_timestamp:
            at_stamp = self._pose_at_stamp(samples[-1], ctx)
            if at_stamp is None:
                ctx.error("Transform", ctx.frames.why_not(grid.frame, samples[-1].stamp_ns))
                return
            outer, frame = at_stamp, None
        for (corner, image), offset in zip(
            images.items(), self._offsets(grid, outer, list(images)), strict=True
        ):
            key = f"tile {corner[0]} {corner[1]}"
            ctx.follow(frame, when="now", offset=offset, key=key).add(key, image)
        self._report(folded, grid, ctx)

    def _pose_at_stamp(self, sample: Sample, ctx: Context) -> Pose | None:
        """Where the frame was at the stamp; remembered, as transforms are kept for seconds only."""
        key = (ctx.frames.fixed_frame, sample.frame, sample.stamp_ns)
        if pose := ctx.frames.at(sample.frame, sample.stamp_ns):
            ctx.state["pose at stamp"] = (key, pose)
        known, pose = ctx.state.get("pose at stamp", (None, None))
        return pose if known == key else None

    def _offsets(self, grid: TiledGrid, outer: Pose, corners: list[Corner]) -> list[Pose]:
        """Pose of each tile; `outer` is that of the grid's frame."""
        xyz = np.zeros((len(corners), 3))
        xyz[:, 1::-1] = np.array(corners) * grid.resolution  # rows lie along y, columns along x
        xyz[:, 2] = BEHIND if self.draw_behind else 0.0
        positions = transformed(outer, transformed(grid.origin, xyz)).tolist()
        w, x, y, z = multiply(outer.wxyz, grid.origin.wxyz).tolist()
        return [Pose((px, py, pz), (w, x, y, z)) for px, py, pz in positions]

    def _report(self, folded: Folded, grid: TiledGrid, ctx: Context) -> None:
        size = f"{grid.width} x {grid.height} cells of {grid.resolution:.4g} m"
        if self.alpha == 0:
            ctx.warn("Map", f"{size}, invisible: alpha is 0.")
        else:
            ctx.ok("Map", f"{size} in frame '{grid.frame}'.")
        if folded.update_fault:
            ctx.error("Update", folded.update_fault)
        elif folded.updates:
            count = f"{folded.updates} update{'s' if folded.updates > 1 else ''}"
            ctx.ok("Update", f"{count} since the last whole map.")


def _images(
    grid: TiledGrid, table: NDArray[np.uint8], state: dict[str, Any]
) -> dict[Corner, Image]:
    """A node for each tile, those of the call before where nothing changed."""
    look = (table, grid.resolution)
    before: dict[Corner, tuple[NDArray[np.int8], Image]] = {}
    if (known := state.get("look")) and known[0] is table and known[1] == grid.resolution:
        before = state["tiles"]
    tiles = {}
    for corner, cells in grid.tiles.items():
        old = before.get(corner)
        if old is None or old[0] is not cells:
            rows, columns = cells.shape
            width, height = columns * grid.resolution, rows * grid.resolution
            old = (cells, Image(colorize(cells, table), width, height))
        tiles[corner] = old
    state["look"], state["tiles"] = look, tiles
    return {corner: image for corner, (_, image) in tiles.items()}
