"""Messages as serialised CDR: where a package is missing (tf2_msgs), or rclpy is slow (Path)."""

import struct
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from webviz_sim.description import Transform

_LITTLE_ENDIAN = b"\x00\x01\x00\x00"  # encapsulation header of plain CDR


def tf_message(stamped: Iterable[tuple[int, Transform]]) -> bytes:
    """Serialises transforms.

    Args:
        stamped: Each transform with its stamp in nanoseconds.

    Returns:
        The CDR bytes, encapsulation header included.
    """
    stamped = list(stamped)
    body = bytearray(struct.pack("<I", len(stamped)))
    for stamp, transform in stamped:
        _align(body, 4)
        body += struct.pack("<iI", *divmod(stamp, 1_000_000_000))
        for frame in (transform.parent, transform.child):
            text = frame.encode() + b"\0"
            _align(body, 4)
            body += struct.pack("<I", len(text)) + text
        _align(body, 8)
        body += struct.pack("<7d", *transform.translation, *transform.rotation)
    return _LITTLE_ENDIAN + bytes(body)


def _align(body: bytearray, size: int) -> None:
    """Pads; CDR aligns each value to its size, counted from behind the header."""
    body += bytes(-len(body) % size)


def path_message(stamp: int, points: NDArray[np.float64]) -> bytes:
    """Serialises a nav_msgs/Path in the frame `map`, whose poses look along the path.

    rclpy would need a second of a core for 50 such messages, this needs a few milliseconds.

    Args:
        stamp: In nanoseconds, for the path and its poses.
        points: Shape (n, 2), metres; n at least 2.

    Returns:
        The CDR bytes, encapsulation header included.
    """
    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
    header = struct.pack("<iII4s", seconds, nanoseconds, 4, b"map\0")
    directions = np.gradient(points, axis=0)
    half = 0.5 * np.arctan2(directions[:, 1], directions[:, 0])
    poses = np.zeros(len(points), dtype=[("header", "V16"), ("pose", "<f8", 7)])
    poses["header"] = np.void(header)
    poses["pose"][:, :2] = points
    poses["pose"][:, 5] = np.sin(half)
    poses["pose"][:, 6] = np.cos(half)
    body = poses.tobytes()
    # The first pose comes behind 16 + 4 + 16 bytes, so its doubles need 4 more to be aligned; each
    # further pose is 72 bytes behind and needs none.
    return b"".join(
        (_LITTLE_ENDIAN, header, struct.pack("<I", len(points)), header, bytes(4), body[16:])
    )
