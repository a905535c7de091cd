"""The PointStamped display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np

from webviz import Color, Context, Details, Display, Hit, Input, Pose, Prop, Sample, Topic
from webviz.data.rotations import matrices
from webviz.data.words import counted
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import Length, is_drawable, origin_near
from webviz_displays.shared.properties import HistoryLength, opaque


class PointStamped(Display):
    """A point, such as one that was clicked in RViz."""

    rviz = "rviz_default_plugins/PointStamped"

    topic: Annotated[
        Topic,
        Input("geometry_msgs/msg/PointStamped", is_sporadic=True),
        Prop(help="Topic of the points."),
    ] = Topic("/clicked_point")
    color: Annotated[Color, Prop(help="Colour of the spheres.")] = (204, 41, 204)
    alpha: Annotated[Alpha, Prop(help="Opacity; 0 is invisible.")] = 1.0
    radius: Annotated[Length, Prop(rviz_factor=2.0, help="Radius of the spheres.")] = 0.2
    history_length: HistoryLength = 1

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Spheres, each where its frame was at its stamp."""
        if not samples:
            return
        pairs = [(each.message.point, each.pose) for each in samples]
        points = np.array([(p.x, p.y, p.z) for p, _ in pairs])
        ids = np.flatnonzero(is_drawable(points))
        if len(ids):
            turns = matrices([pose.wxyz for _, pose in pairs])[ids]
            places = np.array([pose.position for _, pose in pairs])[ids]
            centers = np.einsum("nij,nj->ni", turns, points[ids]) + places
            origin = origin_near(centers)
            group = ctx.follow(None, offset=Pose(origin))
            if self.alpha == 0:
                ctx.warn(
                    "Point", "Invisible: alpha is 0. Increase it to show the points.", opaque()
                )
            else:
                ctx.ok("Point", f"Showing {counted(len(ids), 'point')}.")
                group.instances(
                    "points",
                    "sphere",
                    centers - origin,
                    2 * self.radius,
                    self.color,
                    opacity=self.alpha,
                    ids=ids,
                )
        if len(samples) - 1 not in ids:
            x, y, z = points[-1].tolist()
            ctx.error(
                "Point",
                f"The point ({x:g}, {y:g}, {z:g}) is not finite or farther than 1e9 m. "
                "Fix the publisher.",
            )

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the point in its own frame."""
        sample = hit.samples[hit.id]
        return Details(f"Point {sample.number}", {f"Point in {sample.frame}": sample.message.point})
