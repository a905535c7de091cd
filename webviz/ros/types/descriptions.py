"""Type descriptions and their hashes (REP 2016)."""

from __future__ import annotations

import hashlib
import json
from typing import Any, NamedTuple

from rosbags.interfaces import Nodetype

from webviz.data.messages import typestore

# Primitive types by their number in type_description_interfaces/msg/FieldType, and in the
# introspection's field_types.h. A `char` in a .msg file is a uint8 to both, a `byte` an octet.
_DESCRIBED = {"int8": 2, "uint8": 3, "char": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7}
_DESCRIBED |= {"int64": 8, "uint64": 9, "float32": 10, "float64": 11, "bool": 15, "byte": 16}
_DESCRIBED |= {"octet": 16, "string": 17, "wstring": 18}
_DESCRIBED_NESTED = 1
_DESCRIBED_BOUNDED_STRING = 21
ARRAY, BOUNDED_SEQUENCE, SEQUENCE = 48, 96, 144  # added to a FieldType's number


class Member(NamedTuple):
    """One member of a type.

    Args:
        name: as in the definition.
        type_name: a primitive, or the full name of a nested type.
        string_bound: maximum length of a string, 0 for unbounded.
        repeated: 0 for one value, else `ARRAY`, `BOUNDED_SEQUENCE` or `SEQUENCE`.
        capacity: length of an array or upper bound of a sequence, else 0.
    """

    name: str
    type_name: str
    string_bound: int
    repeated: int
    capacity: int

    @property
    def is_nested(self) -> bool:
        """Return whether it holds a type instead of a primitive."""
        return self.type_name not in _DESCRIBED


def fields(type_name: str) -> list[Member]:
    """Return the members of a type in order of serialisation.

    Raises:
        UnknownTypeError: the type is unknown.
    """
    result = []
    node: Any
    detail: Any
    for name, (node, detail) in typestore.described(type_name):
        repeated = capacity = 0
        if node in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            is_array = node == Nodetype.ARRAY
            (node, detail), capacity = detail
            repeated = ARRAY if is_array else BOUNDED_SEQUENCE if capacity else SEQUENCE
        base, bound = (detail, 0) if node == Nodetype.NAME else detail
        result.append(Member(name, base, bound, repeated, capacity))
    return result


def describe(type_name: str) -> dict[str, Any]:
    """Return the description of a type as JSON data, with its keys in the order of the hash.

    Raises:
        UnknownTypeError: the type, or one of its nested types, is unknown.
    """
    described: dict[str, dict] = {}

    def visit(name: str) -> None:
        if name not in described:
            members = fields(name)
            described[name] = {
                "type_name": name,
                "fields": [{"name": f.name, "type": _describe_field(f)} for f in members],
            }
            for member in members:
                if member.is_nested:
                    visit(member.type_name)

    visit(type_name)
    return {
        "type_description": described.pop(type_name),
        "referenced_type_descriptions": [described[name] for name in sorted(described)],
    }


def type_hash(type_name: str) -> str:
    """Return the `RIHS01_…` hash of a type, computed from its definition.

    The function of rosbags disagrees with rosidl about `char`, as in std_msgs/msg/Char.

    Raises:
        UnknownTypeError: as `describe`.
    """
    text = json.dumps(describe(type_name))
    return f"RIHS01_{hashlib.sha256(text.encode()).hexdigest()}"


def _describe_field(field: Member) -> dict[str, Any]:
    number = _DESCRIBED.get(field.type_name, _DESCRIBED_NESTED)
    return {
        "type_id": field.repeated + (_DESCRIBED_BOUNDED_STRING if field.string_bound else number),
        "capacity": field.capacity,
        "string_capacity": field.string_bound,
        "nested_type_name": field.type_name if field.is_nested else "",
    }
