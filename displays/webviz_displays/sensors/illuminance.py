"""The Illuminance display."""

from __future__ import annotations

from typing import Annotated, ClassVar

from webviz import Input, Prop, Topic
from webviz_displays.sensors.scalar_display import HIGHEST, LOWEST, ScalarDisplay


class Illuminance(ScalarDisplay):
    """Brightness as the colour of a point at its sensor."""

    rviz = "rviz_default_plugins/Illuminance"
    quantity: ClassVar[str] = "illuminance"
    unit: ClassVar[str] = "lx"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/Illuminance"), Prop(help="Topic of the measurements.")
    ] = Topic("/illuminance")
    min_intensity: Annotated[float, LOWEST] = 0.0
    max_intensity: Annotated[float, HIGHEST] = 1000.0
