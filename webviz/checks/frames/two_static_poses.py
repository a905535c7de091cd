"""Frames with two static poses."""

from __future__ import annotations

from webviz.checks.frames.conflicting import ConflictCheck
from webviz.data.transforms.conflicts import ConflictKind


class TwoStaticPoses(ConflictCheck):
    """Frame with two static poses.

    Two static transforms give one frame different poses in the same parent.

    Why:
        Often a static_transform_publisher in a launch file repeats what the robot description says,
        with other numbers. Which one a node uses depends on which came last.

    Repair:
        Remove the transform from the launch file or from the robot description.
    """

    id = "TF009"
    kind = ConflictKind.TWO_STATIC_POSES
    topic = "/tf_static"
