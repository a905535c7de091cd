"""The tool that tells a localisation where the robot is."""

from __future__ import annotations

import math
from typing import Annotated

from webviz.api.declared import Prop, Topic
from webviz.api.ports import Output
from webviz.api.tool import Confirm, Gesture, Tool, ToolContext

X, Y, YAW = 0, 7, 35
"""Places on the diagonal of a covariance of 6 x 6."""


class PoseEstimate(Tool):
    """Set the pose of the robot for localisation: press at the position, drag towards the heading.

    It is on the ground, the plane z = 0 of the fixed frame. With Ctrl held, moving the pointer up
    lifts it.
    """

    title = "2D Pose Estimate"
    rviz = "rviz_default_plugins/SetInitialPose"
    shortcut = "p"
    order = 1
    icon = "target"
    gesture = "pose"

    topic: Annotated[
        Topic,
        Output("geometry_msgs/msg/PoseWithCovarianceStamped"),
        Prop(help="Where poses are published."),
    ] = Topic("/initialpose")
    covariance_x: Annotated[
        float, Prop(ge=0, unit="m²", rviz="Covariance x", help="Variance of x.")
    ] = 0.5**2
    covariance_y: Annotated[
        float, Prop(ge=0, unit="m²", rviz="Covariance y", help="Variance of y.")
    ] = 0.5**2
    covariance_yaw: Annotated[
        float, Prop(ge=0, unit="rad²", rviz="Covariance yaw", help="Variance of the heading.")
    ] = (math.pi / 12) ** 2
    confirm: Confirm = False

    def done(self, gesture: Gesture, ctx: ToolContext) -> None:
        """Publish the pose in the fixed frame, stamped now, as RViz does."""
        covariance = [0.0] * 36
        covariance[X], covariance[Y] = self.covariance_x, self.covariance_y
        covariance[YAW] = self.covariance_yaw
        pose = {"pose": gesture.pose, "covariance": covariance}
        ctx.publish("topic", {"header": ctx.header, "pose": pose})
