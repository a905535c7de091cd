"""The Imu display."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import (
    Color,
    Context,
    Details,
    Display,
    Group,
    Hit,
    Input,
    Pose,
    Prop,
    Remedy,
    Sample,
    Topic,
)
from webviz.data.rotations import matrices, normalized
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import FARTHEST, LONGEST, Length
from webviz_displays.shared.pose_marks import report_orientations
from webviz_displays.shared.rods import add_solid_arrows

AXES_RADIUS = 0.05
"""Radius of axes of length 1, as in RViz."""

SHAFT_RADIUS, HEAD_LENGTH, HEAD_RADIUS = 0.25, 1.0, 0.5
"""Shape of the arrow of the acceleration in scales; rviz_imu_plugin gives the diameters."""

F64 = NDArray[np.float64]


class BoxSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A box that turns with the sensor."""

    enable_box: Annotated[bool, Prop(rviz="Enable box", help="Draw a box.")] = False
    x_scale: Annotated[
        Length, Prop(rviz="x_scale", when=("enable_box", True), help="Extent along x.")
    ] = 1.0
    y_scale: Annotated[
        Length, Prop(rviz="y_scale", when=("enable_box", True), help="Extent along y.")
    ] = 1.0
    z_scale: Annotated[
        Length, Prop(rviz="z_scale", when=("enable_box", True), help="Extent along z.")
    ] = 1.0
    box_color: Annotated[
        Color, Prop(rviz="Box color", when=("enable_box", True), help="Colour of the box.")
    ] = (255, 0, 0)
    box_alpha: Annotated[
        Alpha,
        Prop(
            rviz="Box alpha", when=("enable_box", True), help="Opacity of the box; 0 is invisible."
        ),
    ] = 1.0


class AxesSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Axes that turn with the sensor."""

    enable_axes: Annotated[bool, Prop(rviz="Enable axes", help="Draw axes.")] = True
    axes_scale: Annotated[
        Length, Prop(rviz="Axes scale", when=("enable_axes", True), help="Length of the axes.")
    ] = 1.0


class AccelerationSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An arrow along the acceleration."""

    enable_acceleration: Annotated[
        bool, Prop(rviz="Enable acceleration", help="Draw the acceleration.")
    ] = False
    derotate_acceleration: Annotated[
        bool,
        Prop(
            rviz="Derotate acceleration",
            when=("enable_acceleration", True),
            help="Turn the acceleration by the orientation, so that gravity always points up.",
        ),
    ] = True
    acc_vector_scale: Annotated[
        float,
        Prop(
            gt=0,
            le=LONGEST,
            rviz="Acc. vector scale",
            when=("enable_acceleration", True),
            help="Metres per m/s², and the length of the arrow's head in m.",
        ),
    ] = 1.0
    acc_vector_color: Annotated[
        Color,
        Prop(
            rviz="Acc. vector color",
            when=("enable_acceleration", True),
            help="Colour of the acceleration.",
        ),
    ] = (255, 0, 0)
    acc_vector_alpha: Annotated[
        Alpha,
        Prop(
            rviz="Acc. vector alpha",
            when=("enable_acceleration", True),
            help="Opacity of the acceleration; 0 is invisible.",
        ),
    ] = 1.0


class Imu(Display):
    """Orientation and acceleration as an inertial sensor measures them."""

    rviz = "rviz_imu_plugin/Imu"

    topic: Annotated[Topic, Input("sensor_msgs/msg/Imu"), Prop(help="Topic of the sensor.")] = (
        Topic("/imu/data")
    )
    fixed_frame_orientation: Annotated[
        bool,
        Prop(
            rviz="fixed_frame_orientation",
            help="Take the orientation as one in the fixed frame, as most sensors measure it; "
            "otherwise it is relative to the frame of the sensor.",
        ),
    ] = True
    box_properties: Annotated[BoxSettings, Prop(rviz="Box properties", help="A box.")] = (
        BoxSettings()
    )
    axes_properties: Annotated[AxesSettings, Prop(rviz="Axes properties", help="Axes.")] = (
        AxesSettings()
    )
    acceleration_properties: Annotated[
        AccelerationSettings, Prop(rviz="Acceleration properties", help="The acceleration.")
    ] = AccelerationSettings()

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw the enabled parts at the sensor."""
        message = sample.message
        q, a = message.orientation, message.linear_acceleration
        xyzw = np.array((q.x, q.y, q.z, q.w))
        acceleration = np.array((a.x, a.y, a.z))
        if not np.isfinite(xyzw).all():
            ctx.error("Orientation", "The orientation is not finite. Fix the publisher.")
            return
        if message.orientation_covariance[0] == -1:
            ctx.warn(
                "Orientation",
                "The sensor measures no orientation: the first covariance is -1. Everything is "
                "drawn without rotation. Run a filter such as imu_filter_madgwick.",
            )
            xyzw[:] = 0.0, 0.0, 0.0, 1.0
        else:
            with np.errstate(over="ignore"):
                report_orientations(np.square(xyzw[None]).sum(axis=1), "sensor", ctx)
        (wxyz,), _ = normalized([(xyzw[3], *xyzw[:3])])
        is_fixed = self.fixed_frame_orientation
        group = ctx.follow(None, offset=Pose(sample.pose.position) if is_fixed else sample.pose)
        nodes_drawn = [self._box(wxyz, group), self._axes(wxyz, group)]
        nodes_drawn.append(self._acceleration(wxyz, acceleration, group, ctx))
        if not any(nodes_drawn):
            ctx.warn(
                "Imu",
                "Nothing is drawn. Enable the box, the axes or the acceleration, and raise alpha.",
                Remedy("axes_properties.enable_axes", True, "Show the axes"),
            )
        else:
            ctx.ok("Imu", f"Acceleration {_vector_text(a, 'm/s²')}.")

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return what the sensor measures, in its own frame."""
        message, frame = hit.sample.message, hit.sample.frame
        q, turn, acceleration = (
            message.orientation,
            message.angular_velocity,
            message.linear_acceleration,
        )
        return Details(
            "Inertial sensor",
            {
                "Orientation": f"x {q.x:.4f}, y {q.y:.4f}, z {q.z:.4f}, w {q.w:.4f}",
                f"Acceleration in {frame}": _vector_text(acceleration, "m/s²"),
                f"Turn rate in {frame}": _vector_text(turn, "rad/s"),
            },
        )

    def _box(self, wxyz: F64, group: Group) -> bool:
        look = self.box_properties
        if not look.enable_box or look.box_alpha == 0:
            return False
        sizes = look.x_scale, look.y_scale, look.z_scale
        group.instances(
            "box", "box", np.zeros((1, 3)), sizes, look.box_color, [wxyz], look.box_alpha
        )
        return True

    def _axes(self, wxyz: F64, group: Group) -> bool:
        look = self.axes_properties
        if look.enable_axes:
            scale = look.axes_scale
            group.axes("axes", np.zeros((1, 3)), [wxyz], scale, AXES_RADIUS * scale)
        return look.enable_axes

    def _acceleration(self, wxyz: F64, vector: F64, group: Group, ctx: Context) -> bool:
        look = self.acceleration_properties
        if not look.enable_acceleration or look.acc_vector_alpha == 0:
            return False
        scale = look.acc_vector_scale
        with np.errstate(over="ignore", invalid="ignore"):
            shaft = scale * (matrices(wxyz) @ vector if look.derotate_acceleration else vector)
            length = float(np.linalg.norm(shaft))
        if not length < FARTHEST:
            ctx.error(
                "Acceleration", "The acceleration is not finite or too large. Fix the publisher."
            )
            return False
        if length == 0.0:
            ctx.warn(
                "Acceleration",
                "The acceleration is zero, so it has no arrow. Check that the sensor is running.",
            )
            return False
        tip = shaft * (1.0 + HEAD_LENGTH * scale / length)
        segments = np.array([[(0.0, 0.0, 0.0), tip]])
        sizes = SHAFT_RADIUS * scale, HEAD_RADIUS * scale, HEAD_LENGTH * scale
        alpha = look.acc_vector_alpha
        add_solid_arrows(group, segments, look.acc_vector_color, *sizes, alpha, key="acceleration")
        return True


def _vector_text(vector: Any, unit: str) -> str:
    return f"{vector.x:.4g}, {vector.y:.4g}, {vector.z:.4g} {unit}"
