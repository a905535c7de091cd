"""Frames that are static and moving."""

from __future__ import annotations

from webviz.checks.frames.conflicting import ConflictCheck
from webviz.data.transforms.conflicts import ConflictKind


class StaticAndMoving(ConflictCheck):
    """Frame on /tf and on /tf_static.

    A frame is published as a moving transform and as a static one.

    Why:
        A static transform holds at all times, so it hides the moving one or is hidden by it. A
        typical case is a static `map` to `odom` beside AMCL.

    Repair:
        Remove the static transform, which was usually meant as a substitute.
    """

    id = "TF010"
    kind = ConflictKind.STATIC_AND_MOVING
    topic = "/tf"
