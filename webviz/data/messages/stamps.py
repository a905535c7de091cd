"""Moving all stamps of serialised messages, without decoding the rest."""

from __future__ import annotations

import struct

from webviz.data.messages.cdr import Reader
from webviz.data.messages.errors import MessageError
from webviz.data.messages.typestore import (
    KNOWN,
    MessageField,
    MessageTypes,
    fields,
    per_definitions,
    weight,
)

TIME = "builtin_interfaces/msg/Time"
SIZES = {
    **dict.fromkeys(("bool", "byte", "char", "int8", "uint8"), 1),
    **dict.fromkeys(("int16", "uint16"), 2),
    **dict.fromkeys(("int32", "uint32", "float32"), 4),
    **dict.fromkeys(("int64", "uint64", "float64"), 8),
}
"""Bytes of primitives."""
SECOND_NS = 1_000_000_000
MAX_SECONDS = 2**31 - 1
MAX_DEPTH = 30


def shifted(type_name: str, cdr: bytes, by_ns: int, types: MessageTypes = KNOWN) -> bytes:
    """Return a message with all its stamps moved.

    Those that are zero stay, as they mean "now" or none.

    Args:
        type_name: a type that is known.
        cdr: the serialised message.
        by_ns: added to each stamp, which is kept within the range of the type.
        types: that define the type.

    Returns:
        A message of the same length; the same one if it is malformed.
    """
    places: list[int] = []
    try:
        if not by_ns or not has_stamps(type_name, types):
            return cdr
        reader = Reader(cdr)
        _walk(reader, type_name, places, 0, types)
        layout = struct.Struct(f"{reader.order}iI")
        moved = bytearray(cdr)
        for place in places:
            sec, nanosec = layout.unpack_from(moved, place)
            if sec or nanosec:
                total = max(0, sec * SECOND_NS + nanosec + by_ns)
                sec, nanosec = divmod(total, SECOND_NS)
                layout.pack_into(moved, place, min(sec, MAX_SECONDS), nanosec)
    except (MessageError, struct.error, IndexError):
        return cdr
    return bytes(moved)


@per_definitions
def has_stamps(type_name: str, types: MessageTypes) -> bool:
    """Return whether a type has stamps anywhere in it."""
    return type_name == TIME or any(
        each.is_message and has_stamps(each.base, types) for each in fields(type_name, types)
    )


@per_definitions
def _layout(type_name: str, types: MessageTypes) -> tuple[MessageField, ...]:
    return tuple(fields(type_name, types))


@per_definitions
def _stamped(type_name: str, types: MessageTypes) -> int:
    """Return the number of fields up to the last that has stamps."""
    layout = _layout(type_name, types)
    return max(
        (n for n, each in enumerate(layout, 1) if each.is_message and has_stamps(each.base, types)),
        default=0,
    )


def _walk(
    reader: Reader, type_name: str, places: list[int], depth: int, types: MessageTypes
) -> None:
    """Note where the stamps of a message are; of the outermost, the rest is not read."""
    if depth > MAX_DEPTH:
        raise MessageError("it is nested too deeply")
    if type_name == TIME:
        reader.align(4)
        places.append(reader.pos)
        reader.pos += 8
        return
    layout = _layout(type_name, types)
    for field in layout if depth else layout[: _stamped(type_name, types)]:
        _field(reader, field, places, depth, types)


def _field(
    reader: Reader, field: MessageField, places: list[int], depth: int, types: MessageTypes
) -> None:
    size = None if field.is_message else SIZES.get(field.base)
    if size is not None:
        count = 1 if field.size is None else field.size or reader.count()
        if count:
            reader.align(size)
            reader.pos += count * size
        if reader.pos > reader.size:
            raise MessageError("it is cut off")
        return
    each = weight(field.base, types) if field.is_message else 1
    count = 1 if field.size is None else reader.elements(field.size, each)
    for _ in range(count):
        if field.is_message:
            _walk(reader, field.base, places, depth + 1, types)
        elif field.base == "string":
            length = reader.count()
            reader.pos += length
            if reader.pos > reader.size:
                raise MessageError("it is cut off")
        elif field.base == "wstring":
            reader.wstring()
        else:
            raise MessageError(f"{field.base} is unsupported")
