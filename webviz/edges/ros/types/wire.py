"""The bytes of requests and responses on their way through the middleware.

To rclpy a composed request is a Python object with its CDR bytes. To rmw_fastrtps it is a pointer
to a `Blob`, which it hands to the callbacks of the type support together with the `Cdr` of Fast CDR
that writes or reads the sample.
"""

from __future__ import annotations

import ctypes
import functools
import itertools

from webviz.edges.ros.types.structs import capsule, function, struct

ENCAPSULATION = b"\x00\x01\x00\x00"
"""Plain CDR, little endian: how this side begins each serialised message."""

# In Fast CDR 2, a `Cdr` has a reference to its buffer behind seven pointers to members.
_BUFFER_OFFSET = 7 * 16
_FastBuffer = struct("virtual_table buffer size:size")
_pointer = ctypes.c_void_p


class Raw:
    """A request or a response of a composed service.

    Args:
        cdr: serialised, with its encapsulation header.
    """

    __slots__ = ("cdr",)

    def __init__(self, cdr: bytes = b"") -> None:
        self.cdr = cdr


class _Blobs:
    """The messages that the middleware holds pointers to, by an id that stands for the pointer."""

    def __init__(self) -> None:
        self._ids = itertools.count(1)
        self._held: dict[int, bytes] = {}

    def create(self) -> int:
        id = next(self._ids)
        self._held[id] = b""
        return id

    def destroy(self, id: int) -> None:
        self._held.pop(id, None)

    def get(self, id: int) -> bytes:
        return self._held[id]

    def set(self, id: int, cdr: bytes) -> None:
        self._held[id] = cdr


_blobs = _Blobs()


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
    """`cdr_serialize` of a composed type: copies the bytes behind the encapsulation header."""
    body = _blobs.get(blob)[len(ENCAPSULATION) :]
    write = _fastcdr()._ZN8eprosima7fastcdr3Cdr15serialize_arrayEPKcm
    write(cdr, body, len(body))
    return True


def deserialize(cdr: int, blob: int) -> bool:
    """`cdr_deserialize` of a composed type: takes all bytes that are left.

    How many that are stands in the buffer that the first member of a `Cdr` refers to.
    """
    library = _fastcdr()
    begin = library._ZN8eprosima7fastcdr3Cdr18get_buffer_pointerEv(cdr)
    now = library._ZN8eprosima7fastcdr3Cdr20get_current_positionEv(cdr)
    buffer = _FastBuffer.from_address(_pointer.from_address(cdr + _BUFFER_OFFSET).value or 0)
    if buffer.buffer != begin:
        return False  # another layout of Fast CDR than the one this was written for
    body = ctypes.string_at(now, buffer.size - (now - begin))
    _blobs.set(blob, ctypes.string_at(begin, len(ENCAPSULATION)) + body)
    return True


def serialized_size(blob: int) -> int:
    """`get_serialized_size` of a composed type, without the encapsulation header."""
    return len(_blobs.get(blob)) - len(ENCAPSULATION)


def _from_python(message: Raw, blob: int) -> bool:
    _blobs.set(blob, message.cdr)
    return True


def _to_python(blob: int) -> Raw:
    return Raw(_blobs.get(blob))


@functools.cache
def conversions() -> dict[str, object]:
    """The capsules by which rclpy turns a `Raw` into what the middleware takes, and back."""
    return {
        "_CREATE_ROS_MESSAGE": capsule(function(_blobs.create, _pointer)),
        "_DESTROY_ROS_MESSAGE": capsule(function(_blobs.destroy, None, _pointer)),
        "_CONVERT_FROM_PY": capsule(
            function(_from_python, ctypes.c_bool, ctypes.py_object, _pointer)
        ),
        "_CONVERT_TO_PY": capsule(function(_to_python, ctypes.py_object, _pointer)),
    }
