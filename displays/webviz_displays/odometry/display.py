"""The Odometry display."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

import numpy as np

from webviz import Context, Details, Display, Group, Hit, Input, Keep, Pose, Prop, Sample, Topic
from webviz.data import messages
from webviz.data.words import counted
from webviz_displays.odometry import covariance
from webviz_displays.odometry.covariance_marks import add_orientations, add_positions
from webviz_displays.odometry.details import details
from webviz_displays.odometry.poses import GrowingTrail, Trail, fault, has_moved, is_sound
from webviz_displays.shared.geometry import along_x, origin_near
from webviz_displays.shared.pose_properties import Covariance, PoseShape
from webviz_displays.shared.rods import add_transparent_arrows

MOST_COVARIANCES = 100
"""RViz's default Keep. Each covariance is several transparent solids, which browsers sort."""


class Odometry(Display):
    """Where a robot estimates that it was and is, with the uncertainty."""

    rviz = "rviz_default_plugins/Odometry"

    topic: Annotated[Topic, Input("nav_msgs/msg/Odometry"), Prop(help="Topic of the odometry.")] = (
        Topic("/odom")
    )
    position_tolerance: Annotated[
        float, Prop(ge=0, unit="m", help="Add a pose after the robot moved by this distance.")
    ] = 0.1
    angle_tolerance: Annotated[
        float, Prop(ge=0, unit="rad", help="Add a pose after the robot turned by this angle.")
    ] = 0.1
    keep: Annotated[int, Prop(ge=0, help="Number of newest poses to keep; 0 keeps all.")] = 100
    shape: Annotated[PoseShape, Prop(help="How to draw each pose.")] = PoseShape()
    covariance: Annotated[Covariance, Prop(help="How to draw the covariances.")] = Covariance()

    def new_state(self) -> GrowingTrail:
        """No poses."""
        return GrowingTrail()

    def history(self) -> Keep:
        """The newest poses that were accepted."""
        return Keep(count=self.keep)

    def accept(self, new: Sample, kept: Sequence[Sample]) -> bool | str:
        """Whether the robot moved by one of the tolerances, or why the pose is invalid.

        A robot at rest counts as well when its covariance becomes invalid, or valid again.
        """
        if problem := fault(new.message):
            return problem
        if not kept:
            return True
        last: messages.Odometry = kept[-1].message
        if has_moved(new.message, last, self.position_tolerance, self.angle_tolerance):
            return True
        return self.covariance.value and is_sound(new.message) != is_sound(last)

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """All poses as one node, and their covariances as a few more."""
        if not samples:
            return
        ctx.ok("Pose", f"Showing {counted(len(samples), 'pose')}.")
        poses = ctx.state.of(samples)
        origin = origin_near(poses.positions)
        group = ctx.follow(None, offset=Pose(origin))
        poses = replace(poses, positions=poses.positions - origin)
        self._draw_poses(poses, group, ctx)
        if self.covariance.value:
            self._draw_covariances(samples, poses, group, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """A message; the wedges are one mesh, which does not know of its messages."""
        if hit.id is None:
            return Details("Covariances of yaw")
        return details(hit.samples[hit.id])

    def _draw_poses(self, poses: Trail, group: Group, ctx: Context) -> None:
        look = self.shape
        if look.value == "Axes":
            group.axes("poses", poses.positions, poses.wxyzs, look.axes_length, look.axes_radius)
            return
        if look.alpha == 0:
            ctx.warn("Pose", "The arrows are invisible: alpha is 0. Increase it to show them.")
            return
        length = look.shaft_length + look.head_length
        segments = along_x(poses.positions, poses.rotations, length)
        sizes = (look.shaft_radius, look.head_radius, look.head_length)
        if look.alpha < 1:
            add_transparent_arrows(group, segments, look.color, *sizes, look.alpha)
        else:
            group.arrows("poses", segments, look.color, *sizes)

    def _draw_covariances(
        self, samples: Sequence[Sample], poses: Trail, group: Group, ctx: Context
    ) -> None:
        newest = samples[-MOST_COVARIANCES:]
        rows = np.array([s.message.pose.covariance for s in newest])
        given, ok = covariance.read(rows)
        negative = covariance.has_negative_variance(rows)
        if not ok.all():
            ctx.warn(
                "Covariance",
                f"{(~ok).sum()} of {len(ok)} covariances are invalid and not drawn: not finite, "
                f"larger than {covariance.LARGEST:g}, or with a negative eigenvalue.",
            )
        elif negative.any():
            ctx.warn(
                "Covariance",
                f"{negative.sum()} of {len(ok)} covariances have a negative variance of z, roll "
                "or pitch, which counts as 0. Publish 0 if the robot moves in a plane.",
            )
        elif len(samples) > len(newest):
            ctx.ok("Covariance", f"Showing the newest {len(newest)} of {len(samples)} covariances.")
        given = covariance.Covariances(given.matrices[ok], given.is_planar[ok])
        positions, frames, axes = (
            values[-MOST_COVARIANCES:][ok]
            for values in (poses.positions, poses.frames, poses.rotations)
        )
        ids = np.arange(len(samples))[-MOST_COVARIANCES:][ok]
        look = self.covariance.orientation
        if self.covariance.position.value:
            add_positions(group, self.covariance.position, given, positions, frames, ids)
        if look.value:
            axes = axes if look.frame == "Local" else frames
            add_orientations(group, look, given, positions, axes, ids)
