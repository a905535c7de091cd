"""rosbags' own encoder and decoder, which ours must agree with, and messages to try both on."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from random import Random
from typing import Any

import numpy as np
from known_types import OURS
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from webviz.data.messages import FrameTransform, definitions
from webviz.data.messages.classes import VECTORS

VECTOR_NAMES = {name.rpartition("/")[2] for name in VECTORS}


@functools.cache
def rosbags_store() -> Typestore:
    """Return rosbags' store of types, with ours."""
    store = get_typestore(Stores.ROS2_JAZZY)
    for name in OURS:
        store.register(get_types_from_msg(definitions.text(name), name))
    return store


def random_message(type_name: str, rng: Random) -> Any:
    """Return a message of rosbags', with sequences of 0 to 3 elements and strings of 0 to 9 bytes.

    Hypothesis could draw every field, but needs seconds for a marker; it draws the seed.
    """
    values = [
        0 if name == "structure_needs_at_least_one_member" else _value(description, rng)
        for name, description in rosbags_store().fielddefs[type_name][1]
    ]
    return rosbags_store().types[type_name](*values)


def _value(description: Any, rng: Random) -> Any:
    kind, inner = description
    if kind == Nodetype.NAME:
        return random_message(inner, rng)
    if kind == Nodetype.BASE:
        return _primitive(inner[0], rng)
    element, length = inner
    count = length if kind == Nodetype.ARRAY else rng.randint(0, length or 3)
    several = [_value(element, rng) for _ in range(count)]
    if element[0] == Nodetype.NAME or element[1][0] == "string":
        return several
    return np.array(several, _dtype(element[1][0]))


def _dtype(base: str) -> np.dtype:
    return np.dtype({"byte": "uint8", "char": "uint8"}.get(base, base))


def _primitive(base: str, rng: Random) -> Any:
    if base == "string":
        return "".join(rng.choices("map/Karte_\u00e4\u4e16", k=rng.randrange(6)))
    if base == "bool":
        return rng.random() < 0.5
    if base.startswith("float"):
        return rng.choice([0.0, -1.5, rng.randrange(10**6) / 64, float("inf")])
    if base == "byte":  # rosbags takes it for signed, ROS for unsigned
        return rng.randrange(128)
    limits = np.iinfo(_dtype(base))
    return rng.randint(int(limits.min), int(limits.max))


def plain(value: Any) -> Any:
    """Return a message, of rosbags or of ours, as lists and dictionaries of one shape."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, str | int | float):
        return value
    if isinstance(value, FrameTransform):
        return [*value[:3], list(value.translation), list(value.rotation)]
    if hasattr(value, "__len__"):
        return [plain(element) for element in value]
    if type_name := getattr(value, "__msgtype__", None):
        names = [name for name, _ in rosbags_store().fielddefs[type_name][1]]
        names = [name if hasattr(value, name) else f"{name}_" for name in names]
    else:
        type_name, names = type(value).__name__, value.__struct_fields__
    items = {name: plain(getattr(value, name)) for name in names}
    kind = type_name.rpartition("/")[2]
    if kind in (
        "Time",
        "Duration",
    ):  # nanoseconds may exceed a second; they are compared in sum
        return items["sec"] * 10**9 + items["nanosec"]
    if kind == "TransformStamped":
        parent, stamp = items["header"]["frame_id"], items["header"]["stamp"]
        return [parent, items["child_frame_id"], stamp, *items["transform"].values()]
    return list(_numbers(items)) if kind in VECTOR_NAMES else items


def _numbers(value: Any) -> Iterator[float]:
    """The numbers of a message and its nested ones, in the order of the wire."""
    if isinstance(value, dict | list):
        for inner in value.values() if isinstance(value, dict) else value:
            yield from _numbers(inner)
    else:
        yield value
