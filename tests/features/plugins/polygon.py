from typing import Annotated

from webviz import Color, Context, Display, Input, Prop, Sample, Topic


class Area(Display):
    """The outline of a polygon."""

    topic: Annotated[Topic, Input("geometry_msgs/msg/PolygonStamped")] = Topic("/polygon")
    color: Annotated[Color, Prop(help="Colour of the outline.")] = (25, 255, 0)

    def draw(self, sample: Sample, ctx: Context) -> None:
        corners = sample.message.polygon.points  # float32 (N, 3)
        if len(corners) < 3:
            ctx.warn("Area", f"Expected at least 3 corners, got {len(corners)}.")
            return
        ctx.strip("outline", [*corners, corners[0]], self.color)
        ctx.ok("Area", f"{len(corners)} corners.")
