"""Conversion of ROS 1 messages to those of ROS 2, by the .msg text that comes with them."""

from __future__ import annotations

import contextlib
import struct
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore

from webviz.data.messages import typestore
from webviz.data.messages.cdr import MAX_ELEMENTS, TooLargeError
from webviz.data.messages.decode import defined
from webviz.data.messages.encode import encode
from webviz.data.messages.errors import DecodeError
from webviz.data.messages.extents import extent
from webviz.data.messages.typestore import KNOWN, MessageTypes

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


RENAMED = {"tf/msg/tfMessage": "tf2_msgs/msg/TFMessage"}
"""Types by their names in ROS 2."""
_NUMBERS = {
    "bool": "?",
    "byte": "B",  # an octet in ROS 2
    "char": "B",
    "int8": "b",
    "uint8": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}
_TIMES = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
_SIZE = struct.Struct("<I")
_TIME = struct.Struct("<Ii")

TRANSFORMS = "tf2_msgs/msg/TFMessage"

_Read = Callable[["_Message", int], tuple[Any, int]]
"""Reads a value at an offset, and returns it with the offset behind it."""


class _Message:
    """The bytes of a message, and the number of objects that may still be made of it.

    Args:
        data: the bytes.
    """

    def __init__(self, data: bytes) -> None:
        self.data = data
        self._left = MAX_ELEMENTS

    def take(self, count: int) -> None:
        """Count messages and texts; in ROS 1, those without fields have no bytes."""
        self._left -= count
        if self._left < 0:
            raise TooLargeError(f"it has more than {MAX_ELEMENTS} elements")


class Ros1Type:
    """A message type of ROS 1.

    Fields by their names in ROS 2 are kept, whatever their case; those that ROS 2 dropped, such as
    `seq` of headers, are skipped, and those that it added have their default.

    Args:
        name: of the type, such as "sensor_msgs/msg/LaserScan".
        text: its .msg text and those of nested types.

    Raises:
        DefinitionError: the text is invalid or incomplete.
    """

    def __init__(self, name: str, text: str) -> None:
        self._defined: Mapping[str, Any] = typestore.parsed(name, text)
        extent(name, self._fields, {})
        self.name = RENAMED.get(name, name)
        """Name of the type in ROS 2."""
        self._readers: dict[str, _Read] = {}
        self._read = self._message(name)
        text = self.definition()
        self.types: MessageTypes = defined(self.name, text) if text else KNOWN
        """Types in ROS 2."""
        self._is_usual: bool | None = None if self.name == TRANSFORMS else False
        """True if `transforms_to_cdr` reads it; None until both ways were compared."""

    def definition(self) -> str:
        """Return the .msg text of the type in ROS 2, "" if ROS 2 has the type itself."""
        if typestore.type_exists(self.name):
            return ""
        store = get_typestore(Stores.EMPTY)
        for name, fields in self._defined.items():
            is_known = typestore.type_exists(name)
            store.fielddefs[name] = ([], typestore.described(name)) if is_known else fields
        for name in _TIMES:
            store.fielddefs[name] = ([], typestore.described(name))
        return store.generate_msgdef(self.name, ros_version=2)[0]

    def to_cdr(self, data: bytes) -> bytes:
        """Return a message as ROS 2 has it.

        Raises:
            DecodeError: the message is cut off.
            EncodeError: ROS 2 has a field of another type.
        """
        try:
            if self._is_usual:
                return transforms_to_cdr(data)
            values, _ = self._read(_Message(data), 0)
        except TooLargeError as error:
            raise DecodeError(f"This {self.name} of ROS 1 is too large: {error}.") from None
        except (struct.error, UnicodeDecodeError, ValueError) as error:
            raise DecodeError(f"{self.name} of ROS 1 is damaged.") from error
        cdr = encode(self.name, values, self.types)
        if self._is_usual is None and values.get("transforms"):
            # The text that came with the bag decides, which anybody may have written.
            with contextlib.suppress(struct.error, ValueError):
                self._is_usual = transforms_to_cdr(data) == cdr
        return cdr

    def _fields(self, name: str) -> Any:
        """Return the fields of a type, None if it is unknown."""
        if name in _TIMES:
            return typestore.described(name)
        return self._defined[name][1] if name in self._defined else None

    def _message(self, name: str) -> _Read:
        """Return the reader of a message."""
        if name in self._readers:
            return self._readers[name]
        if name in _TIMES:
            return _time
        names = None
        if typestore.type_exists(target := RENAMED.get(name, name)):
            names = {field.name.lower(): field.name for field in typestore.fields(target)}
        fields: list[tuple[str | None, _Read]] = []
        for field, (kind, value) in self._defined[name][1]:
            called = field if names is None else names.get(field.lower())
            fields.append((called, self._field(kind, value)))

        def read(message: _Message, at: int) -> tuple[Any, int]:
            message.take(1)
            items = {}
            for called, read_field in fields:
                value, at = read_field(message, at)
                if called is not None:
                    items[called] = value
            return items, at

        self._readers[name] = read
        return read

    def _field(self, kind: Nodetype, value: Any) -> _Read:
        if kind == Nodetype.NAME:
            return self._message(value)
        if kind == Nodetype.BASE:
            return _string if value[0] == "string" else _number(value[0])
        (inner, base), size = value
        count = size if kind == Nodetype.ARRAY else None
        if inner == Nodetype.BASE and base[0] != "string":
            return _numbers(base[0], count)
        return _several(self._field(inner, base), count)


def _time(message: _Message, at: int) -> tuple[Any, int]:
    seconds, nanoseconds = _TIME.unpack_from(message.data, at)
    seconds = seconds - (1 << 32) if seconds >> 31 else seconds
    return {"sec": seconds, "nanosec": max(nanoseconds, 0)}, at + _TIME.size


def _string(message: _Message, at: int) -> tuple[Any, int]:
    (size,) = _SIZE.unpack_from(message.data, at)
    start = at + _SIZE.size
    if start + size > len(message.data):
        raise ValueError
    return message.data[start : start + size].decode(errors="replace").replace(
        "\0", ""
    ), start + size


def _number(base: str) -> _Read:
    layout = struct.Struct(f"<{_NUMBERS[base]}")

    def read(message: _Message, at: int) -> tuple[Any, int]:
        return layout.unpack_from(message.data, at)[0], at + layout.size

    return read


def _numbers(base: str, count: int | None) -> _Read:
    """Return a reader of an array, of a sequence without a count."""
    dtype = np.dtype(f"<{_NUMBERS[base]}")

    def read(message: _Message, at: int) -> tuple[Any, int]:
        size, at = _count(message, at, count)
        array = np.frombuffer(message.data, dtype, size, at) if size else np.zeros(0, dtype)
        return array, at + size * dtype.itemsize

    return read


def _several(one: _Read, count: int | None) -> _Read:
    """Return a reader of several messages or texts."""

    def read(message: _Message, at: int) -> tuple[Any, int]:
        size, at = _count(message, at, count)
        if count is None and size > len(message.data):
            raise ValueError
        message.take(size)
        items = []
        for _ in range(size):
            value, at = one(message, at)
            items.append(value)
        return items, at

    return read


def _count(message: _Message, at: int, count: int | None) -> tuple[int, int]:
    if count is not None:
        return count, at
    return _SIZE.unpack_from(message.data, at)[0], at + _SIZE.size
