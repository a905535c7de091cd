"""The Twist display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from webviz import Context, Input, Prop, Sample, Topic
from webviz_displays.shared.frame_names import frame_of
from webviz_displays.vectors.motion_display import MotionDisplay


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
