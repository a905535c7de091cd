"""The displays of single numbers: FluidPressure, Illuminance, RelativeHumidity, Temperature."""

from __future__ import annotations

from typing import Annotated, ClassVar

from webviz import Input, Prop, Topic
from webviz_displays.sensors.scalar_display import HIGHEST, LOWEST, ScalarDisplay
from webviz_displays.shared.points_display import InvertRainbow


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


class Illuminance(ScalarDisplay):
    """How bright it is, as the colour of a point where its sensor is."""

    rviz = "rviz_default_plugins/Illuminance"
    quantity: ClassVar[str] = "illuminance"
    unit: ClassVar[str] = "lx"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/Illuminance"), Prop(help="Topic of the measurements.")
    ] = Topic("/illuminance")
    min_intensity: Annotated[float, LOWEST] = 0.0
    max_intensity: Annotated[float, HIGHEST] = 1000.0


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
