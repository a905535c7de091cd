"""A tool with a gesture of its own: an outline drawn by hand, published as a polygon."""

from typing import Annotated

from webviz import Gesture, Output, Tool, ToolContext, Topic


class KeepOut(Tool):
    """Publish an area to keep out of: draw its outline on the ground."""

    title = "Keep Out"
    gesture, module = "outline", "keep_out.js"
    icon = "M5 5l14 3-3 11-9-2z"

    topic: Annotated[Topic, Output("geometry_msgs/msg/PolygonStamped")] = Topic("/keep_out")

    def done(self, gesture: Gesture, ctx: ToolContext) -> None:
        """Publish the area."""
        if len(gesture.points) < 3:
            ctx.error("An area needs at least 3 corners. Draw a longer outline.")
            return
        corners = [dict(zip("xyz", point, strict=True)) for point in gesture.points]
        ctx.publish("topic", {"header": ctx.header, "polygon": {"points": corners}})
