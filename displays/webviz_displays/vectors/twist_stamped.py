"""The TwistStamped display."""

from __future__ import annotations

from typing import Annotated

from webviz import Input, Prop, Topic
from webviz_displays.shared.history import HistoryLength
from webviz_displays.vectors.motion_display import MotionDisplay


class TwistStamped(MotionDisplay):
    """A linear and an angular velocity, drawn at the origin of their frame."""

    rviz = "rviz_default_plugins/TwistStamped"
    field = "twist"

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/TwistStamped"), Prop(help="Topic of the velocities.")
    ] = Topic("/twist")
    history_length: HistoryLength = 1
