"""Encoding messages."""

from __future__ import annotations

from typing import Any

from webviz.data.messages.cdr import LITTLE_ENDIAN
from webviz.data.messages.encoders import Misfit, encoder
from webviz.data.messages.errors import EncodeError
from webviz.data.messages.typestore import KNOWN, MessageTypes


def encode(type_name: str, values: Any = None, types: MessageTypes = KNOWN) -> bytes:
    """Encode a message as ROS 2 does: plain CDR, little endian, without trailing padding.

    Args:
        type_name: Such as "sensor_msgs/msg/LaserScan" or, as in ROS 1, "sensor_msgs/LaserScan".
        values: A mapping of field names to values, with nested mappings for nested messages; or an
            instance of `message_class(type_name)`, or any other object with such attributes.
            Missing keys have their default; so have all fields for None. Arrays are numpy arrays,
            lists or other sequences of numbers; those of points and quaternions may be (N, 3) and
            (N, 4).
        types: that define the type.

    Returns:
        The bytes as `decode` takes them, encapsulation header included.

    Raises:
        EncodeError: A value is invalid. The text names the field and what it expects.
        UnknownTypeError: No definition of the type is known.
    """
    out = bytearray(LITTLE_ENDIAN)
    try:
        encoder(type_name, types)(out, {} if values is None else values)
    except Misfit as misfit:
        end = "" if misfit.reason.endswith("?") else "."
        raise EncodeError(f"{type_name}{misfit.where}: {misfit.reason}{end}") from misfit
    return bytes(out)
