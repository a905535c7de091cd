"""Messages of any type from nested mappings, serialised by an independent library."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from webviz.messages.definitions import DEFINITIONS

SECOND = 1_000_000_000

STORE = get_typestore(Stores.ROS2_JAZZY)
for _name, _text in DEFINITIONS.items():
    STORE.register(get_types_from_msg(_text, _name))


def serialized(type_name: str, values: Mapping[str, Any]) -> bytes:
    """CDR bytes of a message; fields left out are zero or empty."""
    return bytes(STORE.serialize_cdr(message(type_name, values), type_name))


def message(type_name: str, values: Mapping[str, Any]) -> Any:
    """A rosbags message from nested mappings."""
    fields = STORE.fielddefs[type_name][1]
    assert values.keys() <= {name for name, _ in fields}, f"{type_name} has no such field"
    return STORE.types[type_name](
        **{name: _value(description, values.get(name)) for name, description in fields}
    )


def _value(description: Any, value: Any) -> Any:
    kind, detail = description
    if kind == Nodetype.NAME:
        return message(detail, value or {})
    if kind == Nodetype.BASE:
        return ("" if detail[0] == "string" else 0) if value is None else value
    element, length = detail
    if element[0] == Nodetype.NAME or element[1][0] == "string":
        return [_value(element, item) for item in value or ()]
    dtype = {"byte": "uint8", "char": "uint8"}.get(element[1][0], element[1][0])
    return np.asarray(np.zeros(length or 0) if value is None else value, dtype)


def header(frame: str, stamp_ns: int) -> dict[str, Any]:
    """A std_msgs/Header as nested mappings."""
    sec, nanosec = divmod(stamp_ns, SECOND)
    return {"frame_id": frame, "stamp": {"sec": sec, "nanosec": nanosec}}
