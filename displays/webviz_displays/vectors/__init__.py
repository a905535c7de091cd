"""Displays of forces, torques, velocities and accelerations."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from webviz import Color, Context, Input, Prop, Remedy, Sample, Topic
from webviz.data import messages
from webviz_displays.shared.properties import HistoryLength, frame_of
from webviz_displays.vectors.effort import Effort
from webviz_displays.vectors.vector_display import VectorDisplay, VectorLook

__all__ = ["AccelStamped", "Effort", "Twist", "TwistStamped", "Wrench"]


class MotionDisplay(VectorDisplay):
    """Base of displays of a linear and an angular velocity or acceleration."""

    units: ClassVar[tuple[str, str]] = ("m/s", "rad/s")
    """SI units of the linear and the angular part."""
    field: ClassVar[str] = ""
    """The field of a message that has both, "" for the message itself."""

    linear_color: Annotated[Color, Prop(help="Colour of the linear part.")] = (204, 51, 51)
    angular_color: Annotated[Color, Prop(help="Colour of the angular part.")] = (204, 204, 51)
    linear_arrow_scale: Annotated[
        float, Prop(gt=0, help="Length of the shaft in metres per SI unit of the linear part.")
    ] = 2.0
    angular_arrow_scale: Annotated[
        float, Prop(gt=0, help="Length of the shaft in metres per SI unit of the angular part.")
    ] = 2.0
    hide_small_values: Annotated[
        bool,
        Prop(rviz_default=True, help="Hide arrows whose shaft is not longer than Arrow Width."),
    ] = False

    def vectors(self, message: Any) -> tuple[messages.Vector3, messages.Vector3]:
        """Return the linear and the angular part."""
        both = getattr(message, self.field) if self.field else message
        return both.linear, both.angular

    def looks(self) -> tuple[VectorLook, VectorLook]:
        """Return the linear and the angular part."""
        linear, angular = self.units
        return (
            VectorLook("linear", linear, self.linear_color, self.linear_arrow_scale),
            VectorLook("angular", angular, self.angular_color, self.angular_arrow_scale),
        )

    def hides(self, lengths: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Zero, or small ones if they are to be hidden."""
        return lengths <= (self.arrow_width if self.hide_small_values else 0.0)

    def why_hidden(self) -> tuple[str, Remedy | None]:
        """Return why neither is drawn, and what would show them."""
        if self.hide_small_values:
            text = "Hide Small Values hides arrows that are not longer than Arrow Width."
            return text, Remedy("hide_small_values", False, "Show small values")
        return super().why_hidden()


class Twist(MotionDisplay):
    """A velocity without a header, such as a command for a robot's base.

    Its message names no frame, so it is drawn at the origin of the reference frame, and moves with
    it. Only the newest is shown, because nothing says where the former ones belong.
    """

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/Twist"), Prop(help="Topic of the velocities.")
    ] = Topic("/cmd_vel")
    reference_frame: Annotated[
        str, Prop(widget="frame", help="Frame in which the velocity is given.")
    ] = "base_link"

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the newest velocity, at the origin of the reference frame."""
        if samples:
            group = ctx.follow(frame_of(self.reference_frame))
            self.draw_vectors(samples, (0.0, 0.0, 0.0), group, ctx)


class TwistStamped(MotionDisplay):
    """A linear and an angular velocity, drawn at the origin of their frame."""

    rviz = "rviz_default_plugins/TwistStamped"
    field = "twist"

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/TwistStamped"), Prop(help="Topic of the velocities.")
    ] = Topic("/twist")
    history_length: HistoryLength = 1


class AccelStamped(MotionDisplay):
    """A linear and an angular acceleration, drawn at the origin of their frame."""

    rviz = "rviz_default_plugins/AccelStamped"
    units = ("m/s²", "rad/s²")
    field = "accel"

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/AccelStamped"), Prop(help="Topic of the accelerations.")
    ] = Topic("/accel")
    history_length: HistoryLength = 1


class Wrench(VectorDisplay):
    """A force and a torque, such as those that a sensor in a wrist measures."""

    rviz = "rviz_default_plugins/Wrench"

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/WrenchStamped"), Prop(help="Topic of the wrenches.")
    ] = Topic("/wrench")
    accept_nan_values: Annotated[
        bool, Prop(rviz="Accept NaN Values", help="Draw values that are NaN as 0.")
    ] = False
    force_color: Annotated[Color, Prop(help="Colour of the force.")] = (204, 51, 51)
    torque_color: Annotated[Color, Prop(help="Colour of the torque.")] = (204, 204, 51)
    force_arrow_scale: Annotated[
        float, Prop(gt=0, unit="m/N", help="Length of the shaft per N.")
    ] = 2.0
    torque_arrow_scale: Annotated[
        float, Prop(gt=0, unit="m/Nm", help="Length of the shaft per Nm.")
    ] = 2.0
    history_length: HistoryLength = 1

    def vectors(self, message: Any) -> tuple[messages.Vector3, messages.Vector3]:
        """Force and torque."""
        wrench = message.wrench
        if self.accept_nan_values:
            return _without_nan(wrench.force), _without_nan(wrench.torque)
        return wrench.force, wrench.torque

    def looks(self) -> tuple[VectorLook, VectorLook]:
        """Force and torque."""
        return (
            VectorLook("force", "N", self.force_color, self.force_arrow_scale),
            VectorLook("torque", "Nm", self.torque_color, self.torque_arrow_scale),
        )


def _without_nan(vector: messages.Vector3) -> messages.Vector3:
    x, y, z = (0.0 if math.isnan(v) else v for v in (vector.x, vector.y, vector.z))
    return messages.Vector3(x, y, z)
