"""Frames with two parents."""

from __future__ import annotations

from webviz.checks.frames.conflicting import ConflictCheck
from webviz.data.transforms.conflicts import ConflictKind


class TwoParents(ConflictCheck):
    """Frame with two parents.

    Transforms give one frame two different parents.

    Why:
        A frame has one parent. Which of the two is drawn depends on which transform came last, so
        everything in the frame jumps between two places.

    Repair:
        Stop one of the publishers, or give the frames different names. Two robots without a frame
        prefix are a frequent cause.
    """

    id = "TF008"
    kind = ConflictKind.TWO_PARENTS
    topic = "/tf_static"
