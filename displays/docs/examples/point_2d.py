"""The display that RViz's tutorial of plug-ins builds, as a display of webviz."""

from typing import Annotated, Literal

import numpy as np

from webviz import Color, Context, Display, Input, Prop, Sample, Topic


class PointDisplay(Display):
    """A point in the plane of its frame."""

    rviz = "rviz_plugin_tutorial::PointDisplay"

    topic: Annotated[Topic, Input("rviz_plugin_tutorial_msgs/msg/Point2D")] = Topic("/point")
    style: Annotated[Literal["cube", "sphere"], Prop(help="Shape of the point.")] = "cube"
    color: Annotated[Color, Prop(help="Colour of the point.", rviz="Point Color")] = (36, 64, 142)

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw a shape of 1 m; webviz places it in the frame of the message, at its stamp."""
        point = sample.message
        if not np.isfinite([point.x, point.y]).all():
            ctx.error("Point", "The coordinates are not finite numbers. Fix the publisher.")
            return
        shape = "box" if self.style == "cube" else "sphere"
        ctx.instances("point", shape, [(point.x, point.y, 0.0)], 1.0, self.color)
        if point.x < 0:
            ctx.warn("Point", f"x is negative: {point.x:g}.")
        else:
            ctx.ok("Point", f"Showing ({point.x:g}, {point.y:g}).")
