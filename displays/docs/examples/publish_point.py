"""A tool that publishes the point that is clicked."""

from typing import Annotated

from webviz import Output, Prop, Stroke, Tool, ToolContext, Topic


class PublishPoint(Tool):
    """Publish a point on the ground: click it."""

    title = "Publish Point"
    rviz = "rviz_default_plugins/PublishPoint"
    shortcut = "u"
    gesture = "point"

    topic: Annotated[
        Topic, Output("geometry_msgs/msg/PointStamped"), Prop(help="Where points are published.")
    ] = Topic("/clicked_point")

    def done(self, stroke: Stroke, ctx: ToolContext) -> None:
        """Publish the point in the fixed frame."""
        x, y, z = stroke.position
        ctx.publish("topic", {"header": ctx.header, "point": {"x": x, "y": y, "z": z}})
