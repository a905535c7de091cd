"""The RelativeHumidity display."""

from __future__ import annotations

from typing import Annotated, ClassVar

from webviz import Input, Prop, Topic
from webviz_displays.sensors.scalar_display import HIGHEST, LOWEST, ScalarDisplay


class RelativeHumidity(ScalarDisplay):
    """A humidity from 0 to 1, as the colour of a point where its sensor is."""

    rviz = "rviz_default_plugins/RelativeHumidity"
    quantity: ClassVar[str] = "relative_humidity"
    unit: ClassVar[str] = ""

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/RelativeHumidity"), Prop(help="Topic of the measurements.")
    ] = Topic("/humidity")
    min_intensity: Annotated[float, LOWEST] = 0.0
    max_intensity: Annotated[float, HIGHEST] = 1.0
