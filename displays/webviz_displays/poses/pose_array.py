"""The PoseArray display."""

from __future__ import annotations

from typing import Annotated

from webviz import Context, Details, Display, Hit, Input, Prop, Sample, Topic
from webviz.data import messages
from webviz_displays.poses.pose_set import (
    ArrowAlpha,
    ArrowColor,
    Shape,
    is_invisible,
    pose_details,
    pose_set,
)
from webviz_displays.shared.geometry import LONGEST, Length
from webviz_displays.shared.history import HistoryLength

BY_FLAT = ("shape", "Arrow (Flat)")
BY_SOLID = ("shape", "Arrow (3D)")
BY_AXES = ("shape", "Axes")


class PoseArray(Display):
    """Several poses, such as candidates for a grasp."""

    rviz = "rviz_default_plugins/PoseArray"
    is_threaded = True

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/PoseArray"), Prop(help="Topic of the poses.")
    ] = Topic("/poses")
    shape: Shape = "Arrow (Flat)"
    color: ArrowColor = (255, 25, 0)
    alpha: ArrowAlpha = 1.0
    arrow_length: Annotated[Length, Prop(when=BY_FLAT, help="Length of flat arrows.")] = 0.3
    shaft_length: Annotated[
        float, Prop(ge=0, le=LONGEST, unit="m", when=BY_SOLID, help="Length of the shafts.")
    ] = 0.23
    shaft_radius: Annotated[
        Length, Prop(when=BY_SOLID, rviz_factor=2.0, help="Radius of the shafts.")
    ] = 0.01
    head_length: Annotated[Length, Prop(when=BY_SOLID, help="Length of the heads.")] = 0.07
    head_radius: Annotated[
        Length, Prop(when=BY_SOLID, rviz_factor=2.0, help="Radius of the heads.")
    ] = 0.03
    axes_length: Annotated[Length, Prop(when=BY_AXES, help="Length of each axis.")] = 0.3
    axes_radius: Annotated[
        Length, Prop(when=BY_AXES, rviz_factor=2.0, help="Radius of each axis.")
    ] = 0.01
    history_length: HistoryLength = 1

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One array, in the frame and at the stamp of its header."""
        poses: messages.PoseSequence = sample.message.poses
        found = pose_set(poses.positions, poses.orientations, sample, ctx, "pose")
        if found is None:
            return
        if self.shape == "Axes":
            found.draw_axes(self.axes_length, self.axes_radius)
        elif is_invisible(self.alpha, ctx, "pose"):
            return
        elif self.shape == "Arrow (Flat)":
            found.draw_flat(self.arrow_length, self.color, self.alpha)
        else:
            length = self.shaft_length + self.head_length
            sizes = self.shaft_radius, self.head_radius, self.head_length
            found.draw_arrows(length, *sizes, self.color, self.alpha)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a pose in its own frame."""
        poses: messages.PoseSequence = hit.sample.message.poses
        return pose_details(hit, "Pose", poses[hit.id], len(poses))
