"""Displays of areas."""

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
    Pose,
    Prop,
    Sample,
    Topic,
    compose,
)
from webviz.data.words import counted
from webviz_displays.areas.grid_cells import GridCells
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import is_drawable, origin_near
from webviz_displays.shared.properties import HistoryLength, opaque

__all__ = ["GridCells", "Polygon"]


class Polygon(Display):
    """The outline of an area, such as the footprint of a robot."""

    rviz = "rviz_default_plugins/Polygon"
    is_threaded = True

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/PolygonStamped"), Prop(help="Topic of the polygons.")
    ] = Topic("/local_costmap/published_footprint")
    color: Annotated[Color, Prop(help="Colour of the outline.")] = (25, 255, 0)
    alpha: Annotated[Alpha, Prop(help="Opacity of the outline.")] = 1.0
    history_length: HistoryLength = 1

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One closed line, in the frame and at the stamp of its header."""
        points = sample.message.polygon.points
        bad = np.flatnonzero(~is_drawable(points))
        if len(bad):
            x, y, z = points[bad[0]].tolist()
            ctx.error(
                "Polygon",
                f"Point {bad[0]} of {len(points)}, ({x:g}, {y:g}, {z:g}), is not finite or "
                "farther than 1e9 m: the polygon is not drawn. Fix the publisher.",
            )
            return
        if len(points) < 2:
            ctx.warn(
                "Polygon",
                f"The polygon has {counted(len(points), 'point')}; a line needs two. "
                "Check the publisher.",
            )
            return
        if self.alpha == 0:
            ctx.warn("Polygon", "Invisible: alpha is 0. Increase it to show the polygon.", opaque())
            return
        ctx.ok("Polygon", f"Showing {counted(len(points), 'point')}.")
        origin = origin_near(points)
        group = ctx.follow(None, offset=compose(sample.pose, Pose(origin)))
        corners = np.append(points, points[:1], axis=0) - origin
        group.strip("outline", corners, self.color, opacity=self.alpha)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a side, from one corner to the next."""
        points = hit.sample.message.polygon.points
        start, end = points[hit.id], points[(hit.id + 1) % len(points)]
        return Details(
            f"Side {hit.id}",
            {
                "Length": f"{np.linalg.norm(end.astype(float) - start):.4g} m",
                f"From, in {hit.sample.frame}": start,
                f"To, in {hit.sample.frame}": end,
                "Points in the polygon": len(points),
            },
        )
