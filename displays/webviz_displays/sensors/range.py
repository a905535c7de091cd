"""The Range display."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np

from webviz import Color, Context, Details, Display, Hit, Input, Keep, Prop, Quantity, Sample, Topic
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import FARTHEST
from webviz_displays.shared.opaque import opaque
from webviz_displays.shared.rods import rods

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
        return 0.0, f"Nothing is within {low:g} m, so there is no cone."
    if distance == math.inf:
        return 0.0, f"Nothing within the range of {high:g} m; there is no cone."
    if distance == -math.inf:
        return 0.0, f"Something is closer than {low:g} m, so its distance is unknown."
    if low <= distance <= high:
        return distance, f"Showing {distance:.4g} m."
    return 0.0, f"The range {distance:g} m is not between {low:g} and {high:g} m; there is no cone."
