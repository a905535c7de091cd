"""The TwistStamped display."""

from __future__ import annotations

from typing import Annotated, Any

from webviz import Input, Prop, Topic
from webviz.data import messages
from webviz_displays.shared.history import HistoryLength
from webviz_displays.vectors.motion_display import MotionDisplay


class TwistStamped(MotionDisplay):
    """A linear and an angular velocity, drawn at the origin of their frame."""

    rviz = "rviz_default_plugins/TwistStamped"

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/TwistStamped"), Prop(help="Topic of the velocities.")
    ] = Topic("/twist")
    history_length: HistoryLength = 1

    def vectors(self, message: Any) -> tuple[messages.Vector3, messages.Vector3]:
        """Linear and angular velocity."""
        return message.twist.linear, message.twist.angular

    def units(self) -> tuple[str, str]:
        """Those of velocities."""
        return "m/s", "rad/s"
