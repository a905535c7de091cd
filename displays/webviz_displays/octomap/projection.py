"""Displays of octrees as flat maps."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from webviz import Input, Prop, Remedy, Topic
from webviz.data import messages
from webviz_displays.map.display import MapDisplay
from webviz_displays.map.tiles import GridFault
from webviz_displays.octomap.display import OCTOMAP
from webviz_displays.octomap.octree import (
    LEVELS,
    SLOW_BYTES,
    Octree,
    OctreeFault,
    memory_for,
    read_octree,
)
from webviz_displays.octomap.voxels import voxels_of

I64 = NDArray[np.int64]

MAX_CELLS = 16_000_000
"""Largest number of cells of a map; they take about 250 MB while it is made."""

UPDATE = "map_msgs/msg/OccupancyGridUpdate"
_UNKNOWN, _FREE, _OCCUPIED = -1, 0, 100


def projected(tree: Octree, depth: int) -> Any:
    """Return a tree seen from above, with the fields of a nav_msgs/msg/OccupancyGrid.

    A cell is occupied if any voxel above or below it is, free if all known ones are.

    Args:
        tree: any.
        depth: below which it is cut off; its voxels are the cells.

    Raises:
        GridFault: there are too many cells.
    """
    voxels = voxels_of(tree, depth)
    size = tree.resolution * 2.0 ** (LEVELS - depth)
    edges = np.rint(voxels.sizes / size).astype(np.int64)
    lows = np.rint((voxels.centers - voxels.sizes[:, None] / 2) / size).astype(np.int64)[:, :2]
    corner = lows.min(axis=0)
    lows -= corner
    width, height = (lows + edges[:, None]).max(axis=0).tolist()
    if width * height > MAX_CELLS:
        fits = depth - math.ceil(math.log(width * height / MAX_CELLS, 4))
        raise GridFault(
            f"The map would have {width} x {height} cells; at most {MAX_CELLS} can be drawn. "
            "Lower Max. Octree Depth.",
            Remedy("max_octree_depth", fits, f"Stop at depth {fits} from the next octree on"),
        )
    is_occupied = tree.log_odds[voxels.nodes] >= 0
    cells = np.full((height, width), _UNKNOWN, np.int8)
    for chosen, value in ((~is_occupied, _FREE), (is_occupied, _OCCUPIED)):
        cells[_covered(lows[chosen], edges[chosen], (height, width))] = value
    x, y = (corner * size).tolist()
    origin = messages.Pose(messages.Point(x, y, 0.0), messages.Quaternion(0.0, 0.0, 0.0, 1.0))
    info = SimpleNamespace(width=width, height=height, resolution=size, origin=origin)
    return SimpleNamespace(info=info, data=cells.ravel())


def _covered(lows: I64, edges: I64, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """Return the cells (height, width) in at least one square.

    Args:
        lows: column and row (N, 2) of the first cell of each square.
        edges: (N,), in cells.
        shape: height and width.
    """
    height, width = shape
    # Each square adds 1 from its first cell on and takes it back behind its end: a double sum.
    steps = np.zeros((height + 1) * (width + 1), np.int32)
    for right, down, sign in ((0, 0, 1), (1, 0, -1), (0, 1, -1), (1, 1, 1)):
        columns, rows = lows[:, 0] + right * edges, lows[:, 1] + down * edges
        places, counts = np.unique(rows * (width + 1) + columns, return_counts=True)
        steps[places] += (sign * counts).astype(np.int32)
    totals = steps.reshape(height + 1, width + 1).cumsum(axis=0, dtype=np.int32)
    return totals.cumsum(axis=1, dtype=np.int32)[:height, :width] > 0


class ProjectedOctree(MapDisplay):
    """Base of RViz's displays of octrees from above."""

    slow_bytes = SLOW_BYTES

    topic: Annotated[Topic, Input(OCTOMAP), Prop(help="Topic of the octrees.")] = Topic(
        "/octomap_binary"
    )
    update_topic: Annotated[
        Topic,
        Input(UPDATE, suffix="_updates", optional=True),
        Prop(help="Topic of partial updates; empty means the octree's topic + _updates."),
    ] = Topic()
    max_octree_depth: Annotated[
        int,
        Prop(
            ge=0,
            le=LEVELS,
            rviz="Max. Octree Depth",
            help="Each level less doubles the size of the cells; 0 is all levels. Applies to the "
            "next octree.",
        ),
    ] = LEVELS

    def as_grid(self, name: str, message: Any) -> Any:
        """Return an octree seen from above."""
        if name != "topic":
            return message
        try:
            with memory_for(message):
                return projected(read_octree(message), self.max_octree_depth or LEVELS)
        except OctreeFault as fault:
            raise GridFault(str(fault)) from fault


class OccupancyMap(ProjectedOctree):
    """An octree from above: where anything is occupied at any height."""

    rviz = "octomap_rviz_plugins/OccupancyMap"


class OccupancyMapStamped(ProjectedOctree):
    """An octree whose nodes have stamps, from above."""

    rviz = "octomap_rviz_plugins/OccupancyMapStamped"
