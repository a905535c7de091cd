"""Attachments of messages and requests: sequence number, time and identity of their sender.

Little endian: an int64, an int64 in nanoseconds since the epoch, the number of bytes of the
identity, which is 16, and the identity; 33 bytes. Versions before 2025 wrote the name of each field
before it. Read in ros2/rmw_zenoh (`attachment_helpers.cpp`), ZettaScaleLabs/hiroz, Pico-ROS and
PX4's zenoh module; copper-rs still writes names.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

import xxhash

GID_BYTES = 16
_FORMAT = struct.Struct("<qqB16s")
_NAMED = struct.Struct("<16sq17sq12s16s")
"""The same with a length and a name before each value."""
_NAMES = (b"\x0fsequence_number", b"\x10source_timestamp", b"\x0asource_gid\x10")


class Attachment(NamedTuple):
    """Sender of a message.

    Attributes:
        sequence: number of the message, from 1.
        stamp_ns: wall time of the sender, in nanoseconds.
        gid: identity of the sender, 16 bytes.
    """

    sequence: int
    stamp_ns: int
    gid: bytes


def write_attachment(attachment: Attachment) -> bytes:
    """Return the bytes of an attachment."""
    return _FORMAT.pack(attachment.sequence, attachment.stamp_ns, GID_BYTES, attachment.gid)


def read_attachment(data: bytes) -> Attachment | None:
    """Return an attachment, with names or without; None if it is malformed."""
    if len(data) == _FORMAT.size:
        sequence, stamp_ns, size, gid = _FORMAT.unpack(data)
        return Attachment(sequence, stamp_ns, gid) if size == GID_BYTES else None
    if len(data) == _NAMED.size:
        first, sequence, second, stamp_ns, third, gid = _NAMED.unpack(data)
        return Attachment(sequence, stamp_ns, gid) if (first, second, third) == _NAMES else None
    return None


def gid_of(token: str) -> bytes:
    """Return the identity of an endpoint: XXH3 of its token in 128 bits, the low half first."""
    return xxhash.xxh3_128_intdigest(token.encode()).to_bytes(GID_BYTES, "little")
