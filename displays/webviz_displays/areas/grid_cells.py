"""The GridCells display."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from webviz import (
    Color,
    Context,
    Details,
    Display,
    Hit,
    Input,
    Mesh,
    Pose,
    Prop,
    Sample,
    Topic,
    compose,
)
from webviz.data.words import counted
from webviz_displays.point_cloud2.decimation import evenly
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import FARTHEST, is_drawable, origin_near
from webviz_displays.shared.properties import HistoryLength, opaque

MAX_CELLS = 50_000
"""Cells drawn per message; each takes 72 bytes to send."""

_CORNERS = np.array(((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)))
_TRIANGLES = np.array(((0, 1, 2), (0, 2, 3)), np.uint32)


class GridCells(Display):
    """Cells of a grid, such as obstacles of a costmap."""

    rviz = "rviz_default_plugins/GridCells"
    is_threaded = True

    topic: Annotated[Topic, Input("nav_msgs/msg/GridCells"), Prop(help="Topic of the cells.")] = (
        Topic("/grid_cells")
    )
    color: Annotated[Color, Prop(help="Colour of the cells.")] = (25, 255, 0)
    alpha: Annotated[Alpha, Prop(help="Opacity; 0 is invisible.")] = 1.0
    history_length: HistoryLength = 1

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw a flat rectangle for each cell, in the frame and at the stamp of the header."""
        width, height = sample.message.cell_width, sample.message.cell_height
        cells = sample.message.cells
        if not (0 < width < FARTHEST and 0 < height < FARTHEST):
            ctx.error(
                "Cells",
                f"The cells are {width:g} m x {height:g} m, so none is drawn. Set cell_width and "
                "cell_height in the publisher.",
            )
            return
        if not len(cells):
            ctx.warn("Cells", "The message has no cells. Check its publisher.")
            return
        ids = np.flatnonzero(is_drawable(cells))
        if not len(ids):
            ctx.error("Cells", "No cell is finite and nearer than 1e9 m. Fix the publisher.")
            return
        ctx.ok("Cells", f"Showing {counted(len(cells), 'cell')} of {width:g} m x {height:g} m.")
        if len(ids) < len(cells):
            ctx.warn(
                "Cells",
                f"{len(cells) - len(ids)} of {len(cells)} cells are not finite or farther than "
                "1e9 m and not drawn. Fix the publisher.",
            )
        if len(ids) > MAX_CELLS:
            ctx.warn("Cells", f"Showing {MAX_CELLS} of {len(cells)} cells, evenly picked.")
            ids = ids[evenly(len(ids), MAX_CELLS)]
        if self.alpha == 0:
            ctx.warn("Cells", "Invisible: alpha is 0. Increase it to show the cells.", opaque())
            return
        centers = cells[ids]
        origin = origin_near(centers)
        vertices = np.repeat(centers - origin, len(_CORNERS), axis=0)
        vertices[:, :2] += np.tile(_CORNERS * (width, height), (len(centers), 1))
        firsts = np.arange(0, len(vertices), len(_CORNERS), dtype=np.uint32)
        faces = (firsts[:, None, None] + _TRIANGLES).reshape(-1, 3)
        group = ctx.follow(None, offset=compose(sample.pose, Pose(origin)))
        mesh = Mesh(vertices.astype(np.float32), faces, self.color, self.alpha, is_flat=True)
        group.add("cells", mesh)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the cell nearest to what was clicked."""
        message = hit.sample.message
        clicked = np.add(hit.point, origin_near(message.cells[is_drawable(message.cells)]))
        distances = np.linalg.norm(message.cells - clicked, axis=1)
        nearest = int(np.nanargmin(distances))
        return Details(
            f"Cell {nearest}",
            {
                f"Centre in {hit.sample.frame}": message.cells[nearest],
                "Size": f"{message.cell_width:g} m x {message.cell_height:g} m",
                "Cells in the message": len(message.cells),
            },
        )
