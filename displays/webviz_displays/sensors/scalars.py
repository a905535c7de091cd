"""Displays of one measured number: a coloured point, with RViz's properties."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, ClassVar

import numpy as np

from webviz import ColorScale, Context, Details, Hit, Input, Pose, Prop, Sample, Topic
from webviz_displays.shared.colors import RAINBOW, ramp
from webviz_displays.shared.geometry import origin_near
from webviz_displays.shared.opaque import opaque
from webviz_displays.shared.points_display import (
    InvertRainbow,
    MaxColor,
    MinColor,
    PointStyle,
)

LOWEST = Prop(help="Value that gets the minimum colour.")
HIGHEST = Prop(help="Value that gets the maximum colour.")


class ScalarDisplay(PointStyle):
    """Base of displays that draw a point where a sensor is, coloured by what it measures."""

    quantity: ClassVar[str]
    """Measured quantity, which names the field of the message."""
    unit: ClassVar[str]
    """Of the quantity, as the message has it; "" for a ratio."""

    use_rainbow: Annotated[
        bool,
        Prop(
            rviz="Use rainbow",
            help="Colour from red (low) to magenta (high) instead of between two colours.",
        ),
    ] = True
    invert_rainbow: InvertRainbow = False
    min_color: MinColor = (0, 0, 0)
    max_color: MaxColor = (255, 255, 255)
    min_intensity: Annotated[float, LOWEST] = 0.0
    max_intensity: Annotated[float, HIGHEST] = 1.0

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """All measurements as one node, each where its frame was at its stamp."""
        if not samples:
            return
        values = np.array([getattr(sample.message, self.quantity) for sample in samples])
        ids = np.flatnonzero(np.isfinite(values))
        said = self._amount(values[-1])
        if not math.isfinite(values[-1]):
            ctx.error("Value", f"The {self._noun} is {said}. Check the sensor.")
        elif self.alpha == 0:
            ctx.warn("Value", f"Invisible: alpha is 0. The {self._noun} is {said}.", opaque())
        else:
            ctx.ok("Value", said)
        if not len(ids) or self.alpha == 0:
            return
        xyz = np.array([samples[i].pose.position for i in ids.tolist()])
        rainbow = RAINBOW[::-1] if self.invert_rainbow else RAINBOW
        stops = rainbow if self.use_rainbow else (self.min_color, self.max_color)
        low, high = self.min_intensity, self.max_intensity
        label = f"{self._noun} ({self.unit})" if self.unit else self._noun
        ctx.color_scale = ColorScale(label, low, high, stops)
        origin = origin_near(xyz)
        group = ctx.follow(None, offset=Pose(origin))
        points = (xyz - origin).astype(np.float32)
        self.draw_points(points, ramp(values[ids], low, high, stops), group, ctx, ids=ids)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the measured value."""
        message = hit.samples[hit.id].message
        values: dict[str, object] = {"Value": self._amount(getattr(message, self.quantity))}
        if message.variance > 0:
            values["Standard deviation"] = self._amount(math.sqrt(message.variance))
        return Details(f"{self._noun.capitalize()} {hit.samples[hit.id].number}", values)

    @property
    def _noun(self) -> str:
        return self.quantity.replace("_", " ")

    def _amount(self, value: float) -> str:
        return f"{value:.6g} {self.unit}".rstrip()


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
    """Brightness as the colour of a point at its sensor."""

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
