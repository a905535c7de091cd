"""Transforms of ROS 1 in the form of ROS 2, field by field: most messages of many bags."""

from __future__ import annotations

import struct

_HEADER = struct.Struct("<Iii")
"""Number, seconds and nanoseconds, as `webviz.data.messages.ros1` reads them."""
_STAMP = struct.Struct("<iI")
_LENGTH = struct.Struct("<I")
_POSE_SIZE = 56
"""Translation and rotation, of seven float64."""
_CDR = b"\0\1\0\0"


def transforms_to_cdr(data: bytes) -> bytes:
    """Return a tf2_msgs/TFMessage of ROS 1 in CDR.

    Raises:
        struct.error, ValueError: it is cut off.
    """
    (count,) = _LENGTH.unpack_from(data)
    out = bytearray(_CDR)
    out += _LENGTH.pack(count)
    at = _LENGTH.size
    for _ in range(count):
        _, sec, nanosec = _HEADER.unpack_from(data, at)
        at += _HEADER.size
        _align(out, 4)
        out += _STAMP.pack(sec, max(nanosec, 0))
        for _ in range(2):  # the frame and its child
            (size,) = _LENGTH.unpack_from(data, at)
            at += _LENGTH.size
            text = data[at : at + size]
            if len(text) < size:
                raise ValueError("cut off")
            at += size
            text = text.decode(errors="replace").replace("\0", "").encode()
            _align(out, 4)
            out += _LENGTH.pack(len(text) + 1) + text + b"\0"
        _align(out, 8)
        pose = data[at : at + _POSE_SIZE]
        if len(pose) < _POSE_SIZE:
            raise ValueError("cut off")
        out += pose
        at += _POSE_SIZE
    return bytes(out)


def _align(out: bytearray, size: int) -> None:
    """Fill up to a multiple of a size, counted behind the encapsulation header."""
    out += bytes(-(len(out) - len(_CDR)) % size)
