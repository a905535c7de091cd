"""Displays of inertial and magnetic sensors."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from webviz import Color, Context, Details, Display, Hit, Input, Prop, Sample, Topic
from webviz_displays.imu.imu import Imu
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import Length
from webviz_displays.shared.properties import opaque
from webviz_displays.shared.rods import add_solid_arrows

__all__ = ["Imu", "Mag"]

SHAFT_LENGTH, SHAFT_RADIUS, HEAD_LENGTH, HEAD_RADIUS = 2.0, 0.05, 0.2, 0.05
"""Shape of the arrow in scales; rviz_imu_plugin gives the diameters."""


class Mag(Display):
    """The direction of a magnetic field, such as a compass measures."""

    rviz = "rviz_imu_plugin/Mag"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/MagneticField"), Prop(help="Topic of the fields.")
    ] = Topic("/imu/mag")
    is_2d: Annotated[
        bool, Prop(rviz="2D-visual", help="Draw the direction in the x-y plane of the sensor.")
    ] = True
    scale: Annotated[Length, Prop(help="Half the length of the arrow's shaft.")] = 1.0
    color: Annotated[Color, Prop(help="Colour of the arrow.")] = (255, 0, 0)
    alpha: Annotated[Alpha, Prop(help="Opacity; 0 is invisible.")] = 1.0

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw an arrow along the field at the sensor, of the same length for every field."""
        field = sample.message.magnetic_field
        vector = np.array((field.x, field.y, 0.0 if self.is_2d else field.z))
        with np.errstate(over="ignore"):
            strength = float(np.linalg.norm(vector))
        if not np.isfinite(vector).all():
            ctx.error(
                "Field",
                f"The field is not finite: {field.x:g}, {field.y:g}, {field.z:g} T. "
                "Fix the publisher.",
            )
            return
        largest = np.abs(vector).max()
        if largest == 0.0:
            ctx.warn("Field", "The field is zero, so it has no direction. Check the sensor.")
            return
        if self.alpha == 0:
            ctx.warn("Field", "Invisible: alpha is 0. Increase it to show the field.", opaque())
            return
        ctx.ok("Field", f"{strength:.4g} T" + (" in the x-y plane." if self.is_2d else "."))
        direction = vector / largest  # first, since squares of small fields may vanish
        direction /= np.linalg.norm(direction)
        length = self.scale * (SHAFT_LENGTH + HEAD_LENGTH)
        segments = np.array([[(0.0, 0.0, 0.0), length * direction]])
        sizes = SHAFT_RADIUS * self.scale, HEAD_RADIUS * self.scale, HEAD_LENGTH * self.scale
        add_solid_arrows(ctx, segments, self.color, *sizes, self.alpha)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the field in the frame of the sensor."""
        field = hit.sample.message.magnetic_field
        return Details(
            "Magnetic field",
            {f"Field in {hit.sample.frame}": f"{field.x:.6g}, {field.y:.6g}, {field.z:.6g} T"},
        )
