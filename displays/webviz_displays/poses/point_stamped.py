"""The PointStamped display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np

from webviz import Color, Context, Details, Display, Hit, Input, Keep, Pose, Prop, Sample, Topic
from webviz.data.words import counted
from webviz_displays.shared.geometry import is_drawable, origin_near, transformed
from webviz_displays.shared.history import HistoryLength


class PointStamped(Display):
    """A point, such as one that was clicked in RViz."""

    rviz = "rviz_default_plugins/PointStamped"

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/PointStamped"), Prop(help="Topic of the points.")
    ] = Topic("/clicked_point")
    color: Annotated[Color, Prop(help="Colour of the spheres.")] = (204, 41, 204)
    alpha: Annotated[float, Prop(ge=0, le=1, widget="slider", help="Opacity; 0 is invisible.")] = (
        1.0
    )
    radius: Annotated[float, Prop(gt=0, unit="m", help="Radius of the spheres.")] = 0.2
    history_length: HistoryLength = 1

    def history(self) -> Keep:
        """The newest points."""
        return Keep(count=self.history_length)

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Spheres, each where its frame was at its stamp."""
        if not samples:
            return
        points = [sample.message.point for sample in samples]
        ids = np.flatnonzero(is_drawable([(p.x, p.y, p.z) for p in points]))
        if len(ids):
            placed = [
                (samples[i].pose, (points[i].x, points[i].y, points[i].z)) for i in ids.tolist()
            ]
            centers = np.concatenate([transformed(pose, [xyz]) for pose, xyz in placed])
            origin = origin_near(centers)
            group = ctx.follow(None, offset=Pose(origin))
            if self.alpha == 0:
                ctx.warn("Point", "Invisible: alpha is 0. Increase it to show the points.")
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
            p = points[-1]
            ctx.error(
                "Point",
                f"The point ({p.x:g}, {p.y:g}, {p.z:g}) is not finite or farther than 1e9 m. "
                "Fix the publisher.",
            )

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """The point in its own frame."""
        sample = hit.samples[hit.id]
        return Details(f"Point {sample.number}", {f"Point in {sample.frame}": sample.message.point})
