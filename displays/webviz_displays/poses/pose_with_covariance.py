"""The PoseWithCovariance display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from webviz import Context, Details, Group, Hit, Input, Prop, Sample, Topic
from webviz.api.nodes import Ids
from webviz_displays.odometry.covariance_marks import draw_covariances
from webviz_displays.odometry.details import covariance_details
from webviz_displays.poses.pose_display import PoseDisplay
from webviz_displays.shared.pose_history import PoseOf, PoseTrail
from webviz_displays.shared.pose_properties import Covariance


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
