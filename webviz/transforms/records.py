"""What the buffer hands out."""

from __future__ import annotations

from dataclasses import dataclass


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


@dataclass(frozen=True, slots=True)
class Rejection:
    """Why the buffer last refused a transform of some child, and how many it has refused.

    Attributes:
        reason: tf2's word for it, such as `TF_OLD_DATA`.
        sentence: the case in words.
        count: transforms of this child refused since the buffer was made or cleared.
        stamp_ns: stamp of the last one refused.
    """

    reason: str
    sentence: str
    count: int
    stamp_ns: int
