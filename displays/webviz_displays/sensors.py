"""Displays of what sensors measure: distances, points and single numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any, ClassVar

import numpy as np

from webviz import (
    Color,
    ColorScale,
    Context,
    Details,
    Display,
    Hit,
    Input,
    Keep,
    Pose,
    Prop,
    Quantity,
    Sample,
    Topic,
)
from webviz.data import messages
from webviz.data.words import listed
from webviz_displays.point_cloud2.cloud import Cloud
from webviz_displays.point_cloud2.display import CloudDisplay
from webviz_displays.shared.colors import RAINBOW, Alpha, ramp
from webviz_displays.shared.geometry import FARTHEST, origin_near
from webviz_displays.shared.points_display import (
    InvertRainbow,
    MaxColor,
    MinColor,
    PointStyle,
)
from webviz_displays.shared.properties import opaque
from webviz_displays.shared.rods import rods

__all__ = ["FluidPressure", "Illuminance", "PointCloud", "Range", "RelativeHumidity", "Temperature"]

LOWEST = Prop(help="Value that gets the minimum colour.")
HIGHEST = Prop(help="Value that gets the maximum colour.")


class ScalarDisplay(PointStyle):
    """Base of displays that draw a point where a sensor is, coloured by what it measures."""

    quantity: ClassVar[str]
    """Measured quantity, which names the field of the message."""
    unit: ClassVar[str]
    """Unit of the quantity, as the message has it; "" for a ratio."""

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
        amount = self._amount(values[-1])
        if not math.isfinite(values[-1]):
            ctx.error("Value", f"The {self._noun} is {amount}. Check the sensor.")
        elif self.alpha == 0:
            ctx.warn("Value", f"Invisible: alpha is 0. The {self._noun} is {amount}.", opaque())
        else:
            ctx.ok("Value", amount)
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


RADIATION = {0: "ultrasound", 1: "infrared"}


class Range(Display):
    """The cone in which an ultrasonic or infrared sensor sees something, up to its distance."""

    rviz = "rviz_default_plugins/Range"

    topic: Annotated[Topic, Input("sensor_msgs/msg/Range"), Prop(help="Topic of the ranges.")] = (
        Topic("/range")
    )
    color: Annotated[Color, Prop(help="Colour of the cones.")] = (255, 255, 255)
    alpha: Annotated[Alpha, Prop(help="Opacity; 0 is invisible.")] = 0.5
    buffer_length: Annotated[
        int, Prop(ge=1, le=10_000, help="How many of the newest ranges to show.")
    ] = 1

    def history(self) -> Keep:
        """Return the newest ranges."""
        return Keep(count=self.buffer_length)

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One cone along x, in the frame and at the stamp of its header."""
        message = sample.message
        angle = message.field_of_view
        if not 0 < angle < math.pi:
            ctx.error(
                "Range",
                f"field_of_view is {angle:g} rad; a cone needs one between 0 and pi. "
                "Set it in the driver.",
            )
            return
        distance, sentence = measured(message)
        if message.range == math.inf:  # no fault, but what the sensor sees
            ctx.ok("Range", sentence)
            return
        radius = distance * math.tan(angle / 2)
        if not 0 < distance < FARTHEST or radius > FARTHEST:
            ctx.warn("Range", sentence)
            return
        if self.alpha == 0:
            ctx.warn("Range", f"Invisible: alpha is 0. {sentence}", opaque())
            return
        ctx.ok("Range", sentence)
        cone = rods([(distance, 0.0, 0.0)], [(0.0, 0.0, 0.0)], 2 * radius)
        ctx.instances("cone", "cone", *cone[:2], self.color, cone.wxyzs, self.alpha)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the message."""
        message = hit.sample.message
        return Details(
            f"Range {hit.sample.number}",
            {
                "Range": Quantity(np.float32(message.range), "m"),
                "Field of view": f"{math.degrees(message.field_of_view):.4g}°",
                "Limits": f"{message.min_range:g} to {message.max_range:g} m",
                "Radiation": RADIATION.get(message.radiation_type, message.radiation_type),
            },
        )


def measured(message: Any) -> tuple[float, str]:
    """Return the distance in metres of a sensor_msgs/Range, 0 if none is drawn, and a sentence.

    By REP 117, +inf is that nothing is in range, and -inf that something is too close. With equal
    limits it is a sensor that only says whether something is within that distance.
    """
    low, high, distance = message.min_range, message.max_range, message.range
    if low == high:
        if distance == -math.inf or distance == low:
            return low, f"Something is within {low:g} m."
        return 0.0, f"Nothing detected within {low:g} m, so no cone is drawn."
    if distance == math.inf:
        return 0.0, f"Nothing detected up to {high:g} m, so no cone is drawn."
    if distance == -math.inf:
        return 0.0, f"Something is closer than {low:g} m, so its distance is unknown."
    if low <= distance <= high:
        return distance, f"Showing {distance:.4g} m."
    return 0.0, f"{distance:g} m is outside the limits, {low:g} to {high:g} m; no cone is drawn."


_FLOAT = np.dtype(np.float32)


class PointCloud(CloudDisplay):
    """Points of a 3D sensor, in the message type before PointCloud2."""

    rviz = "rviz_default_plugins/PointCloud"
    icon = "cloud"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/PointCloud"), Prop(help="Topic of the clouds.")
    ] = Topic("/point_cloud")

    def cloud_of(self, message: Any) -> Cloud:
        """Return the message with its channels as fields; those of another length are left out."""
        points, channels = message.points, message.channels
        fitting = [channel for channel in channels if len(channel.values) == len(points)]
        names = ["x", "y", "z", *(channel.name for channel in fitting)]
        data = np.empty((len(points), len(names)), _FLOAT)
        data[:, :3] = points
        for column, channel in enumerate(fitting, 3):
            data[:, column] = channel.values
        step = data.shape[1] * _FLOAT.itemsize
        cloud = Cloud(
            messages.PointCloud2(
                header=message.header,
                height=1,
                width=len(points),
                fields=[
                    messages.PointField(name, i * _FLOAT.itemsize, messages.PointField.FLOAT32, 1)
                    for i, name in enumerate(names)
                ],
                point_step=step,
                row_step=step * len(points),
                data=data.view(np.uint8).reshape(-1),
            )
        )
        others = [channel for channel in channels if len(channel.values) != len(points)]
        if others:
            sizes = [f"{channel.name!r:.40} with {len(channel.values)}" for channel in others]
            cloud.remark = (
                f"Channels do not have one value for each of the {len(points)} points and are "
                f"ignored: {listed(sizes, 5)}. Fix the publisher."
            )
        return cloud
