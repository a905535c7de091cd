"""The Temperature display."""

from __future__ import annotations

from typing import Annotated, ClassVar

from webviz import Input, Prop, Topic
from webviz_displays.sensors.scalar_display import HIGHEST, LOWEST, ScalarDisplay
from webviz_displays.shared.points_display import InvertRainbow


class Temperature(ScalarDisplay):
    """A temperature, as the colour of a point where its sensor is."""

    rviz = "rviz_default_plugins/Temperature"
    quantity: ClassVar[str] = "temperature"
    unit: ClassVar[str] = "°C"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/Temperature"), Prop(help="Topic of the measurements.")
    ] = Topic("/temperature")
    invert_rainbow: InvertRainbow = True
    min_intensity: Annotated[float, LOWEST] = 0.0
    max_intensity: Annotated[float, HIGHEST] = 100.0
