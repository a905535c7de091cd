"""The header of websocket frames."""

from __future__ import annotations

import struct

_BINARY = 0x82
"""First byte of a frame that is a whole binary message (RFC 6455, section 5.2)."""


def header(size: int) -> bytes:
    """Return the header of an unmasked websocket frame with a binary message of some bytes."""
    if size < 126:
        return struct.pack("!BB", _BINARY, size)
    if size < 1 << 16:
        return struct.pack("!BBH", _BINARY, 126, size)
    return struct.pack("!BBQ", _BINARY, 127, size)
