"""Values returned by the buffer."""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan

from webviz.data.transforms.errors import format_stamp
from webviz.data.transforms.geometry import PoseTuple, canonical


@dataclass(frozen=True, slots=True)
class Transform:
    """Maps coordinates of a source frame into a target frame.

    Attributes:
        translation: (x, y, z) in metres.
        rotation: unit quaternion (x, y, z, w) as in ROS messages.
        stamp_ns: the time it holds for, nanoseconds.
    """

    translation: tuple[float, float, float]
    rotation: tuple[float, float, float, float]
    stamp_ns: int

    @classmethod
    def of(cls, pose: PoseTuple, stamp_ns: int) -> Transform:
        """Return a pose of the tree as tf2 does, with a rotation that went through a matrix."""
        x, y, z, qx, qy, qz, qw = pose
        return cls((x, y, z), canonical(qx, qy, qz, qw), stamp_ns)


@dataclass(frozen=True, slots=True)
class NewestTransform:
    """The newest transform of a frame to its parent.

    Attributes:
        parent: frame id, of the newest transform.
        transform: that transform, from the frame into its parent.
        is_static: whether it holds for all times.
    """

    parent: str
    transform: Transform
    is_static: bool


RECENT_NS = 5_000_000_000
"""Time in ns for which a refused transform that is repeated is reported."""


@dataclass(frozen=True, slots=True)
class Rejection:
    """Reason why the buffer last refused a transform of a child, and how often it did.

    Attributes:
        reason: tf2's name of it, such as `TF_OLD_DATA`.
        sentence: a description.
        count: transforms of this child refused since the buffer was made or cleared.
        stamp_ns: stamp of the last one refused.
        received_ns: when that one was received; 0 if unknown.
        parent: of the last one refused.
        is_static: whether that one is static, so that its publisher does not repeat it.
    """

    reason: str
    sentence: str
    count: int
    stamp_ns: int
    received_ns: int = 0
    parent: str = ""
    is_static: bool = False

    def is_current(self, now_ns: int) -> bool:
        """Return whether it matters: a static one until it is replaced, others for some seconds."""
        return self.is_static or now_ns - self.received_ns < RECENT_NS


@dataclass(frozen=True, slots=True)
class Surplus:
    """Transforms that were refused because the buffer keeps no more frames.

    Attributes:
        child: of the last one refused.
        count: how many were refused since the buffer was made or cleared.
        received_ns: when the last one was received; 0 if unknown.
    """

    child: str
    count: int
    received_ns: int


def fault_of(parent: str, child: str, translation: tuple[float, float, float]) -> tuple[str, str]:
    """Return why a transform is refused at any time: tf2's name, and a description."""
    if child == parent:
        return "TF_SELF_TRANSFORM", "the frame is its own parent"
    if not child:
        return "TF_NO_CHILD_FRAME_ID", "its child frame id is empty"
    if not parent:
        return "TF_NO_FRAME_ID", "its parent frame id is empty"
    if any(isnan(value) for value in translation):
        return "TF_NAN_INPUT", "its translation holds a NaN"
    return "TF_NAN_INPUT", "its rotation holds a NaN or has length zero"


def too_old(stamp_ns: int, newest_ns: int) -> tuple[str, str]:
    """Return why a transform older than the history is refused."""
    return "TF_OLD_DATA", (
        f"its stamp {format_stamp(stamp_ns)} is older than the newest, {format_stamp(newest_ns)}, "
        "by more than the buffer keeps"
    )
