"""The AccelStamped display."""

from __future__ import annotations

from typing import Annotated, Any

from webviz import Input, Prop, Topic
from webviz.data import messages
from webviz_displays.shared.history import HistoryLength
from webviz_displays.vectors.motion_display import MotionDisplay


class AccelStamped(MotionDisplay):
    """A linear and an angular acceleration, drawn at the origin of their frame."""

    rviz = "rviz_default_plugins/AccelStamped"

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/AccelStamped"), Prop(help="Topic of the accelerations.")
    ] = Topic("/accel")
    history_length: HistoryLength = 1

    def vectors(self, message: Any) -> tuple[messages.Vector3, messages.Vector3]:
        """Linear and angular acceleration."""
        return message.accel.linear, message.accel.angular

    def units(self) -> tuple[str, str]:
        """Those of accelerations."""
        return "m/s²", "rad/s²"
