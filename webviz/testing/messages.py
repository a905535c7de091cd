"""Messages of any type from nested mappings, serialised by another library than the viewer's."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from webviz import config
from webviz.messages.definitions import DEFINITIONS
from webviz.testing.source import SECOND

__tracebackhide__ = True  # failures are shown where the test calls


@functools.cache
def store() -> Any:
    """The types of ROS 2 Jazzy, and those that the viewer knows besides."""
    store = get_typestore(Stores.ROS2_JAZZY)
    for name, text in DEFINITIONS.items():
        store.register(get_types_from_msg(text, name))
    return store


def serialized(type_name: str, values: Mapping[str, Any]) -> bytes:
    """CDR bytes of a message; fields left out are zero or empty.

    Raises:
        ValueError: there is no such type or field.
    """
    return bytes(store().serialize_cdr(message(type_name, values), type_name))


def message(type_name: str, values: Mapping[str, Any]) -> Any:
    """A rosbags message from nested mappings.

    Raises:
        ValueError: there is no such type or field.
    """
    if type_name not in store().fielddefs:
        raise ValueError(
            f"No message type {type_name} is known here; publish a ROS message object instead."
        )
    fields = store().fielddefs[type_name][1]
    names = [name for name, _ in fields]
    for key in values:
        if key not in names:
            raise ValueError(f"{type_name} has no field `{key}`, {config.nearest(key, names)}")
    return store().types[type_name](
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
