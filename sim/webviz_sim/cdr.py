"""Messages as serialised CDR: where a package is missing (tf2_msgs), or rclpy is slow (Path)."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from webviz.data.messages import FrameTransform, PoseStampedSequence, encode
from webviz_sim.description import Transform


def tf_message(stamped: Iterable[tuple[int, Transform]]) -> bytes:
    """Serialises transforms.

    Args:
        stamped: Each transform with its stamp in nanoseconds.

    Returns:
        The CDR bytes, encapsulation header included.
    """
    transforms = [
        FrameTransform(each.parent, each.child, stamp, each.translation, each.rotation)
        for stamp, each in stamped
    ]
    return encode("tf2_msgs/msg/TFMessage", {"transforms": transforms})


def path_message(stamp: int, points: NDArray[np.float64]) -> bytes:
    """Serialises a nav_msgs/Path in the frame `map`, whose poses look along the path.

    rclpy would need a second of a core for 50 such messages, this needs a few milliseconds.

    Args:
        stamp: In nanoseconds, for the path and its poses.
        points: Shape (n, 2), metres; n at least 2.

    Returns:
        The CDR bytes, encapsulation header included.
    """
    count = len(points)
    directions = np.gradient(points, axis=0)
    half = 0.5 * np.arctan2(directions[:, 1], directions[:, 0])
    zeros = np.zeros(count)
    poses = PoseStampedSequence(
        np.column_stack([points, zeros]),
        np.column_stack([zeros, zeros, np.sin(half), np.cos(half)]),
        np.full(count, stamp),
        ["map"] * count,
    )
    return encode("nav_msgs/msg/Path", {"header": poses[0].header, "poses": poses})
