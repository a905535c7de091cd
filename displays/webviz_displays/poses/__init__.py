"""Displays of poses and points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np

from webviz import Context, Details, Display, Group, Hit, Input, Prop, Remedy, Sample, Topic
from webviz.api.nodes import Ids
from webviz.data import messages
from webviz.data.messages import PoseSequence
from webviz_displays.odometry.covariance_marks import draw_covariances
from webviz_displays.odometry.details import covariance_details
from webviz_displays.poses.point_stamped import PointStamped
from webviz_displays.poses.pose_display import PoseDisplay
from webviz_displays.poses.pose_set import (
    ArrowAlpha,
    ArrowColor,
    Shape,
    drawable_poses,
    is_invisible,
    pose_details,
)
from webviz_displays.shared.geometry import LONGEST, Length
from webviz_displays.shared.pose_history import PoseOf, PoseTrail
from webviz_displays.shared.pose_properties import Covariance
from webviz_displays.shared.properties import HistoryLength

__all__ = ["ParticleCloud", "PointStamped", "Pose", "PoseArray", "PoseWithCovariance"]

SHAFT_RADIUS, HEAD_LENGTH, HEAD_RADIUS = 0.0435 / 2, 0.3043, 0.1304 / 2
"""Shares of the length of a solid arrow; RViz gives the diameters."""

AXES_RADIUS = 0.0435 / 2
"""Share of the length of axes; RViz gives the diameter."""

_POSITION, _ORIENTATION, _WEIGHT = slice(0, 3), slice(3, 7), 7
"""Columns of the particles."""


class ParticleCloud(Display):
    """Particles of a filter such as amcl: possible poses of the robot with their weights."""

    rviz = "nav2_rviz_plugins/ParticleCloud"
    is_threaded = True

    topic: Annotated[
        Topic, Input("nav2_msgs/msg/ParticleCloud"), Prop(help="Topic of the particles.")
    ] = Topic("/particle_cloud")
    shape: Shape = "Arrow (Flat)"
    color: ArrowColor = (255, 25, 0)
    alpha: ArrowAlpha = 1.0
    min_arrow_length: Annotated[Length, Prop(help="Length of a particle without weight.")] = 0.02
    max_arrow_length: Annotated[Length, Prop(help="Length of a particle of weight 1.")] = 0.3
    history_length: HistoryLength = 1

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One cloud, in the frame and at the stamp of its header."""
        particles = sample.message.particles
        drawables = drawable_poses(
            particles[:, _POSITION], particles[:, _ORIENTATION], sample, ctx, "particle"
        )
        if drawables is None:
            return
        low, high = self.min_arrow_length, self.max_arrow_length
        weights = particles[drawables.ids, _WEIGHT]
        if low > high:
            ctx.warn(
                "Length",
                "Min Arrow Length exceeds Max Arrow Length. Swap them.",
                Remedy("min_arrow_length", high, f"Set Min Arrow Length to {high:g} m"),
            )
            low, high = high, low
        if not np.isfinite(weights).all():
            ctx.warn("Weight", "Weights are not finite and count as 0. Fix the publisher.")
            weights = np.where(np.isfinite(weights), weights, 0.0)
        lengths = low + np.clip(weights, 0.0, 1.0) * (high - low)
        if self.shape == "Axes":
            drawables.draw_axes(lengths, AXES_RADIUS * lengths)
        elif is_invisible(self.alpha, ctx, "particle"):
            return
        elif self.shape == "Arrow (Flat)":
            drawables.draw_flat(lengths, self.color, self.alpha)
        else:
            sizes = SHAFT_RADIUS * lengths, HEAD_RADIUS * lengths, HEAD_LENGTH * lengths
            drawables.draw_arrows(lengths, *sizes, self.color, self.alpha)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a particle: its weight and its pose in its own frame."""
        particles = hit.sample.message.particles
        poses = PoseSequence(particles[:, _POSITION], particles[:, _ORIENTATION])
        details = pose_details(hit, "Particle", poses[hit.id], len(particles))
        return Details(details.title, {"Weight": particles[hit.id, _WEIGHT], **details.values})


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
        drawables = drawable_poses(poses.positions, poses.orientations, sample, ctx, "pose")
        if drawables is None:
            return
        if self.shape == "Axes":
            drawables.draw_axes(self.axes_length, self.axes_radius)
        elif is_invisible(self.alpha, ctx, "pose"):
            return
        elif self.shape == "Arrow (Flat)":
            drawables.draw_flat(self.arrow_length, self.color, self.alpha)
        else:
            length = self.shaft_length + self.head_length
            sizes = self.shaft_radius, self.head_radius, self.head_length
            drawables.draw_arrows(length, *sizes, self.color, self.alpha)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a pose in its own frame."""
        poses: messages.PoseSequence = hit.sample.message.poses
        return pose_details(hit, "Pose", poses[hit.id], len(poses))


class PoseWithCovariance(PoseDisplay):
    """A pose with its uncertainty, such as where a robot was localized."""

    rviz = "rviz_default_plugins/PoseWithCovariance"

    topic: Annotated[
        Topic,
        Input("geometry_msgs/msg/PoseWithCovarianceStamped"),
        Prop(help="Topic of the poses."),
    ] = Topic("/amcl_pose")
    covariance: Annotated[Covariance, Prop(help="How to draw the covariances.")] = Covariance()

    def pose_of(self) -> PoseOf:
        """Return that of a PoseWithCovarianceStamped."""
        return lambda message: message.pose.pose

    def draw_more(
        self, samples: Sequence[Sample], poses: PoseTrail, group: Group, ctx: Context, ids: Ids
    ) -> None:
        """Draw the covariances of the newest poses."""
        draw_covariances(self.covariance, samples, poses, group, ctx, ids)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the pose and its covariance.

        The wedges are one mesh, which does not know of poses.
        """
        if hit.id is None:
            return Details("Covariances of yaw")
        pose = super().inspect(hit, ctx)
        covariance = hit.samples[hit.id].message.pose.covariance
        return Details(pose.title, {**pose.values, **covariance_details(covariance)})


class Pose(PoseDisplay):
    """A pose, such as the goal of a robot."""

    rviz = "rviz_default_plugins/Pose"

    topic: Annotated[
        Topic,
        Input("geometry_msgs/msg/PoseStamped", is_sporadic=True),
        Prop(help="Topic of the poses."),
    ] = Topic("/goal_pose")

    def pose_of(self) -> PoseOf:
        """Return that of a PoseStamped."""
        return lambda message: message.pose
