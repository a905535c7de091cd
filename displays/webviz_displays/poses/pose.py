"""The Pose display."""

from __future__ import annotations

from typing import Annotated

from webviz import Input, Prop, Topic
from webviz_displays.poses.pose_display import PoseDisplay
from webviz_displays.shared.pose_history import PoseOf


class Pose(PoseDisplay):
    """A pose, such as the goal of a robot."""

    rviz = "rviz_default_plugins/Pose"

    topic: Annotated[
        Topic,
        Input("geometry_msgs/msg/PoseStamped", is_sporadic=True),
        Prop(help="Topic of the poses."),
    ] = Topic("/goal_pose")

    def pose_of(self) -> PoseOf:
        """Return that of a PoseStamped."""
        return lambda message: message.pose
