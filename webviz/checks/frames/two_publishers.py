"""Frames with two publishers."""

from __future__ import annotations

from webviz.checks.frames.conflicting import ConflictCheck
from webviz.data.transforms.conflicts import ConflictKind


class TwoPublishers(ConflictCheck):
    """Frame with two publishers.

    A frame alternates between two poses, or has different poses with the same stamp.

    Why:
        Two nodes publish the same transform: the driver of the base and a filter such as
        robot_localization, or one node that was started twice. The robot flickers between two
        places.

    Repair:
        Let only one of them publish it, such as with `publish_tf: false`.
    """

    id = "TF011"
    kind = ConflictKind.TWO_PUBLISHERS
    topic = "/tf"
