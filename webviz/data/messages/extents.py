"""Extents of message types, by which definitions are refused that would take all memory."""

from __future__ import annotations

import keyword
from collections.abc import Callable, Sequence
from typing import NamedTuple

from rosbags.interfaces import Nodetype

from webviz.data.messages.errors import DefinitionError
from webviz.data.messages.msg_text import Description, One

MAX_FIELDS = 20_000
"""Largest number of fields of a message, those of nested messages included, each counted once in an
array."""
MAX_DEPTH = 64
"""Messages within messages; those of ROS have 8 levels. Reading takes four calls for each."""
MAX_FIXED = 100_000
"""Messages and texts in the fixed arrays of a message, all of which its default value has."""
MAX_FIXED_BYTES = 64 << 20
"""Limit in bytes of the numbers in the fixed arrays of a message."""
BYTES_EACH = 8
"""Bytes of a message that pay for one of its objects."""
_SIZES = {"bool": 1, "byte": 1, "char": 1, "int8": 1, "uint8": 1, "int16": 2, "uint16": 2}
_SIZES |= {"int32": 4, "uint32": 4, "float32": 4, "string": 4, "wstring": 4}
"""Bytes that a value takes at least; 8 for all others."""


class Extent(NamedTuple):
    """The least that a message has, nested messages included.

    Args:
        fields: each counted once in an array.
        depth: messages within messages.
        messages: outside arrays, itself included.
        size: bytes on the wire, without padding; of ROS 2, where each message has one.
        fixed: messages and texts in fixed arrays.
        fixed_bytes: of the numbers in fixed arrays.
    """

    fields: int
    depth: int
    messages: int
    size: int
    fixed: int
    fixed_bytes: int

    @property
    def weight(self) -> int:
        """Objects that one of several messages counts as: those beyond one per `BYTES_EACH`."""
        return max(1, self.messages - self.size // BYTES_EACH)


Fields = Callable[[str], Sequence[tuple[str, Description]] | None]
"""Returns the fields of a type by its full name, None if it is unknown."""


def extent(
    type_name: str, fields: Fields, extents: dict[str, Extent], inside: tuple[str, ...] = ()
) -> Extent:
    """Return the extent of a type.

    Args:
        type_name: its full name.
        fields: of all types.
        extents: extents of other types; completed.
        inside: types that contain it.

    Raises:
        DefinitionError: it has a name twice, contains itself or an unknown type, or is above one of
            the limits of this module.
    """
    if type_name in extents:
        return extents[type_name]
    if type_name in inside:
        raise DefinitionError(f"{type_name} cannot contain itself.")
    if len(inside) >= MAX_DEPTH:
        raise _too_deep(inside[0])
    own = fields(type_name)
    if own is None:
        holder = f"{inside[-1]} contains a {type_name}" if inside else type_name
        raise DefinitionError(f"{holder}, whose definition is missing.")
    names: set[str] = set()
    count = depth = size = fixed = fixed_bytes = 0
    messages = 1
    for name, described in own:
        if (own_name := attribute(name)) in names:
            raise DefinitionError(f"{type_name} has the field {name[:40]} twice.")
        names.add(own_name)
        count += 1
        one, length = _split(described)
        if one[0] == Nodetype.NAME:
            inner = extent(one[1], fields, extents, (*inside, type_name))
            count, depth = count + inner.fields, max(depth, inner.depth + 1)
            if length is None:
                messages, size = messages + inner.messages, size + inner.size
                fixed, fixed_bytes = fixed + inner.fixed, fixed_bytes + inner.fixed_bytes
            else:
                size += inner.size * length if length else 4
                fixed += length * (inner.messages + inner.fixed)
                fixed_bytes += length * inner.fixed_bytes
        else:
            each = _SIZES.get(one[1][0], 8)
            size += each if length is None else each * length if length else 4
            if length and one[1][0] in ("string", "wstring"):
                fixed += length
            elif length:
                fixed_bytes += length * each
        if count > MAX_FIELDS:
            raise DefinitionError(f"{type_name} has more than {MAX_FIELDS} fields in all.")
        if len(inside) + depth > MAX_DEPTH:
            raise DefinitionError(
                f"{type_name} has messages nested deeper than {MAX_DEPTH} levels."
            )
        if fixed > MAX_FIXED:
            raise DefinitionError(
                f"{type_name} has fixed arrays of more than {MAX_FIXED} elements in all."
            )
        if fixed_bytes > MAX_FIXED_BYTES:
            raise DefinitionError(
                f"{type_name} has fixed arrays of more than {MAX_FIXED_BYTES >> 20} MB."
            )
    own_extent = extents[type_name] = Extent(count, depth, messages, size, fixed, fixed_bytes)
    return own_extent


def _split(described: Description) -> tuple[One, int | None]:
    """Return the description of one value, and the length of an array; 0 for a sequence."""
    if described[0] == Nodetype.ARRAY:
        return described[1]
    if described[0] == Nodetype.SEQUENCE:
        return described[1][0], 0
    return described, None


def _too_deep(type_name: str) -> DefinitionError:
    return DefinitionError(f"{type_name} has messages nested deeper than {MAX_DEPTH} levels.")


def attribute(name: str) -> str:
    """Return the Python attribute of a field: its name, followed by "_" if that is a keyword."""
    return f"{name}_" if keyword.iskeyword(name) else name
