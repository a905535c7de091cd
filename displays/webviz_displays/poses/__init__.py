"""Displays of poses and points."""

from webviz_displays.poses.particle_cloud import ParticleCloud
from webviz_displays.poses.point_stamped import PointStamped
from webviz_displays.poses.pose import Pose
from webviz_displays.poses.pose_array import PoseArray
from webviz_displays.poses.pose_with_covariance import PoseWithCovariance

__all__ = ["ParticleCloud", "PointStamped", "Pose", "PoseArray", "PoseWithCovariance"]
