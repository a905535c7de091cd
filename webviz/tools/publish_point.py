"""The tool that publishes points."""

from __future__ import annotations

from typing import Annotated

from webviz.api.declared import Prop, Topic
from webviz.api.ports import Output
from webviz.api.tool import Confirm, Gesture, Tool, ToolContext


class PublishPoint(Tool):
    """Publish the point that is clicked, on the surface under the pointer or on the ground."""

    title = "Publish Point"
    rviz = "rviz_default_plugins/PublishPoint"
    shortcut = "u"
    order = 3
    gesture = "point"
    surface = True

    single_click: Annotated[
        bool, Prop(rviz="Single click", help="Leave the tool after one point.")
    ] = True
    topic: Annotated[
        Topic, Output("geometry_msgs/msg/PointStamped"), Prop(help="Where points are published.")
    ] = Topic("/clicked_point")
    confirm: Confirm = False

    @property
    def stays(self) -> bool:
        """Return whether more points may follow."""
        return not self.single_click

    def done(self, gesture: Gesture, ctx: ToolContext) -> None:
        """Publish the point in the fixed frame, stamped now, as RViz does."""
        ctx.publish("topic", {"header": ctx.header, "point": gesture.point})
