"""Bytes of requests and responses, passed through the middleware.

In rclpy a composed request is a Python object with CDR bytes. In rmw_fastrtps it is an opaque
pointer, here an id, which is passed to the callbacks of the type support together with the `Cdr` of
Fast CDR that writes or reads the sample.
"""

from __future__ import annotations

import ctypes
import functools
import itertools

from webviz.ros.types.structs import capsule, function, struct

ENCAPSULATION = b"\x00\x01\x00\x00"
"""Plain CDR, little endian: the header of serialised messages."""

# In Fast CDR 2, a `Cdr` starts with seven pointers to members, then the reference to its buffer.
_BUFFER_OFFSET = 7 * 16
_FastBuffer = struct("virtual_table buffer size:size")
_pointer = ctypes.c_void_p


class RawPayload:
    """A request or response of a composed service.

    Args:
        cdr: serialised, with encapsulation header.
    """

    __slots__ = ("cdr",)

    def __init__(self, cdr: bytes = b"") -> None:
        self.cdr = cdr


_ids = itertools.count(1)
_blobs: dict[int, bytes] = {}
"""The messages in the middleware, by the id that serves as their pointer."""


def _create() -> int:
    id = next(_ids)
    _blobs[id] = b""
    return id


def _destroy(id: int) -> None:
    _blobs.pop(id, None)


@functools.cache
def _fastcdr() -> ctypes.CDLL:
    """Fast CDR as the middleware has loaded it, with the functions used here declared."""
    library = ctypes.CDLL("libfastcdr.so.2")
    for name, result, *arguments in (
        ("_ZN8eprosima7fastcdr3Cdr15serialize_arrayEPKcm", _pointer, ctypes.c_char_p, "size"),
        ("_ZN8eprosima7fastcdr3Cdr18get_buffer_pointerEv", _pointer),
        ("_ZN8eprosima7fastcdr3Cdr20get_current_positionEv", _pointer),
    ):
        each = getattr(library, name)
        each.restype = result
        each.argtypes = [_pointer, *(ctypes.c_size_t if a == "size" else a for a in arguments)]
    return library


def serialize(blob: int, cdr: int) -> bool:
    """`cdr_serialize` of a composed type: copies the bytes after the encapsulation header."""
    body = _blobs[blob][len(ENCAPSULATION) :]
    write = _fastcdr()._ZN8eprosima7fastcdr3Cdr15serialize_arrayEPKcm
    write(cdr, body, len(body))
    return True


def deserialize(cdr: int, blob: int) -> bool:
    """`cdr_deserialize` of a composed type: takes all bytes that remain in the buffer."""
    library = _fastcdr()
    begin = library._ZN8eprosima7fastcdr3Cdr18get_buffer_pointerEv(cdr)
    now = library._ZN8eprosima7fastcdr3Cdr20get_current_positionEv(cdr)
    buffer = _FastBuffer.from_address(_pointer.from_address(cdr + _BUFFER_OFFSET).value or 0)
    if buffer.buffer != begin:
        return False  # the layout of this Fast CDR is unknown
    body = ctypes.string_at(now, buffer.size - (now - begin))
    _blobs[blob] = ctypes.string_at(begin, len(ENCAPSULATION)) + body
    return True


def serialized_size(blob: int) -> int:
    """`get_serialized_size` of a composed type, without encapsulation header."""
    return len(_blobs[blob]) - len(ENCAPSULATION)


def _from_python(message: RawPayload, blob: int) -> bool:
    _blobs[blob] = message.cdr
    return True


def _to_python(blob: int) -> RawPayload:
    return RawPayload(_blobs[blob])


@functools.cache
def conversions() -> dict[str, object]:
    """Return the capsules with which rclpy converts a `RawPayload` for the middleware, and back."""
    return {
        "_CREATE_ROS_MESSAGE": capsule(function(_create, _pointer)),
        "_DESTROY_ROS_MESSAGE": capsule(function(_destroy, None, _pointer)),
        "_CONVERT_FROM_PY": capsule(
            function(_from_python, ctypes.c_bool, ctypes.py_object, _pointer)
        ),
        "_CONVERT_TO_PY": capsule(function(_to_python, ctypes.py_object, _pointer)),
    }
