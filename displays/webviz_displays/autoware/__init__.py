"""Paths, trajectories, objects and poses of Autoware."""

from webviz_displays.autoware.objects import DetectedObjects, PredictedObjects, TrackedObjects
from webviz_displays.autoware.path import AutowarePath, AutowareTrajectory
from webviz_displays.autoware.pose_history import PoseHistory

__all__ = [
    "AutowarePath",
    "AutowareTrajectory",
    "DetectedObjects",
    "PoseHistory",
    "PredictedObjects",
    "TrackedObjects",
]
