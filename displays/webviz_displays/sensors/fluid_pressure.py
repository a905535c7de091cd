"""The FluidPressure display."""

from __future__ import annotations

from typing import Annotated, ClassVar

from webviz import Input, Prop, Topic
from webviz_displays.sensors.scalar_display import HIGHEST, LOWEST, ScalarDisplay


class FluidPressure(ScalarDisplay):
    """A pressure of air or water, as the colour of a point where its sensor is."""

    rviz = "rviz_default_plugins/FluidPressure"
    quantity: ClassVar[str] = "fluid_pressure"
    unit: ClassVar[str] = "Pa"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/FluidPressure"), Prop(help="Topic of the measurements.")
    ] = Topic("/pressure")
    min_intensity: Annotated[float, LOWEST] = 98_000.0
    max_intensity: Annotated[float, HIGHEST] = 105_000.0
