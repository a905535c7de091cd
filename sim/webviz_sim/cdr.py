"""tf2_msgs/TFMessage as serialised CDR, so that no package tf2_msgs is needed to publish it."""

import struct
from collections.abc import Iterable

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
