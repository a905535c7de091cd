"""The AccelStamped display."""

from __future__ import annotations

from typing import Annotated

from webviz import Input, Prop, Topic
from webviz_displays.shared.history import HistoryLength
from webviz_displays.vectors.motion_display import MotionDisplay


class AccelStamped(MotionDisplay):
    """A linear and an angular acceleration, drawn at the origin of their frame."""

    rviz = "rviz_default_plugins/AccelStamped"
    units = ("m/s²", "rad/s²")
    field = "accel"

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/AccelStamped"), Prop(help="Topic of the accelerations.")
    ] = Topic("/accel")
    history_length: HistoryLength = 1
