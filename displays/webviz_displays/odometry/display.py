"""The Odometry display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from msgspec.structs import replace

from webviz import (
    Context,
    Details,
    Display,
    Hit,
    Input,
    Keep,
    Lookback,
    Pose,
    Prop,
    Sample,
    Selective,
    Topic,
)
from webviz.data.words import counted
from webviz_displays.odometry.covariance_marks import draw_covariances
from webviz_displays.odometry.details import details
from webviz_displays.odometry.lookback import TrailRule, kept_poses
from webviz_displays.odometry.poses import fault
from webviz_displays.shared.geometry import origin_near
from webviz_displays.shared.pose_history import GrowingTrail
from webviz_displays.shared.pose_marks import draw_poses
from webviz_displays.shared.pose_properties import Covariance, PoseShape


class Odometry(Display, Selective):
    """Where a robot estimates that it was and is, with the uncertainty."""

    rviz = "rviz_default_plugins/Odometry"
    icon = "odometry"

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
        return GrowingTrail(lambda message: message.pose.pose)

    def history(self) -> Keep:
        """Return the newest poses that were accepted."""
        return Keep(count=self.keep)

    def lookback(self, name: str) -> Lookback:
        """Return the poses that are kept, as far as they do not take too many messages to find."""
        return Lookback(chooses=lambda past: kept_poses(past, self.keep, self.rule()))

    def rule(self) -> TrailRule:
        """Return the rule by which poses are kept."""
        return TrailRule(self.position_tolerance, self.angle_tolerance, self.covariance.value)

    def accept(self, new: Sample, kept: Sequence[Sample]) -> bool | str:
        """Return whether the robot moved by one of the tolerances, or why the pose is invalid.

        A robot at rest counts as well when its covariance becomes invalid, or valid again.
        """
        if problem := fault(new.message):
            return problem
        rule = self.rule()
        return not kept or rule.keeps(rule.place_of(new.message), rule.place_of(kept[-1].message))

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """All poses as one node, and their covariances as a few more."""
        if not samples:
            return
        ctx.ok("Pose", f"Showing {counted(len(samples), 'pose')}.")
        poses = ctx.state.of(samples)
        origin = origin_near(poses.positions)
        group = ctx.follow(None, offset=Pose(origin))
        poses = replace(poses, positions=poses.positions - origin)
        draw_poses(self.shape, poses, group, ctx, path="shape.alpha")
        draw_covariances(self.covariance, samples, poses, group, ctx, np.arange(len(samples)))

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a message; the wedges are one mesh, which does not know of its messages."""
        if hit.id is None:
            return Details("Covariances of yaw")
        return details(hit.samples[hit.id])
