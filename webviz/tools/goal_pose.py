"""The tool that sends goal poses."""

from __future__ import annotations

from typing import Annotated

from webviz.api.declared import Prop, Topic
from webviz.api.ports import Output
from webviz.api.tool import Confirm, Gesture, Tool, ToolContext


class GoalPose(Tool):
    """Send the robot to a pose: press at the position, drag towards the heading.

    It is on the ground, the plane z = 0 of the fixed frame. With Ctrl held, moving the pointer up
    lifts it.
    """

    title = "2D Goal Pose"
    rviz = "rviz_default_plugins/SetGoal"
    shortcut = "g"
    order = 2
    gesture = "pose"

    topic: Annotated[
        Topic, Output("geometry_msgs/msg/PoseStamped"), Prop(help="Where goals are published.")
    ] = Topic("/goal_pose")
    confirm: Confirm = False

    def done(self, gesture: Gesture, ctx: ToolContext) -> None:
        """Publish the pose in the fixed frame, stamped now, as RViz does."""
        ctx.publish("topic", {"header": ctx.header, "pose": gesture.pose})
