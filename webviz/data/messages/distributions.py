"""Messages as other distributions of ROS 2 have them.

Types grow from one distribution to the next, and a message says nothing of its own type. So its
bytes are read by the definition of the distribution that wrote them, and become those of the type
that is known here: fields that are missing have their default, and others are left out.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import Any

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore

from webviz.data.messages import typestore
from webviz.data.messages.decode import decode, defined, is_whole
from webviz.data.messages.encode import encode
from webviz.data.messages.errors import DefinitionError, MessageError
from webviz.data.messages.extents import Extent, attribute, extent
from webviz.data.messages.typestore import MessageField

CHANGED = frozenset(
    {
        "lifecycle_msgs/msg/TransitionEvent",
        "rcl_interfaces/msg/ParameterDescriptor",
        "rmw_dds_common/msg/Gid",
        "rosbag2_interfaces/msg/ReadSplitEvent",
        "rosbag2_interfaces/msg/WriteSplitEvent",
        "sensor_msgs/msg/Range",
        "shape_msgs/msg/SolidPrimitive",
        "visualization_msgs/msg/Marker",
    }
)
"""Types of the core interfaces whose fields differ between Foxy and Lyrical."""
_STORES = (
    Stores.ROS2_LYRICAL,
    Stores.ROS2_KILTED,
    Stores.ROS2_IRON,
    Stores.ROS2_HUMBLE,
    Stores.ROS2_GALACTIC,
    Stores.ROS2_FOXY,
)
"""Distributions beside that of `webviz.data.messages.typestore`, the newest first."""
_OTHER = "Other"
"""Precedes the names of types that differ from those known here."""

_Values = Callable[[Any], Any]
"""Takes the values of a message that a known type has."""


class OtherLayout:
    """A type with more or fewer fields than the one that is known here.

    Args:
        name: full name of the type.
        text: its definition.

    Raises:
        DefinitionError: the text is invalid, or one of its types is another one than that known
            here: it has fields of other types, or both lack fields of the other.
    """

    def __init__(self, name: str, text: str) -> None:
        types = typestore.types_in(name, text)
        known_types = typestore.KNOWN
        reached: dict[str, Extent] = {}
        extent(name, lambda key: (types.get(key) or known_types.get(key) or (0, None))[1], reached)
        self.name = name
        self._fields = {key: typestore.fields_of(types[key]) for key in reached if key in types}
        self._differs = {key for key, own in self._fields.items() if _differs(key, own)}
        while outer := self._outer() - self._differs:
            self._differs |= outer
        store = get_typestore(Stores.EMPTY)
        for key in reached:
            description = types[key][1] if key in types else typestore.described(key)
            store.fielddefs[self._called(key)] = (
                [],
                [(field, self._renamed(kind, value)) for field, (kind, value) in description],
            )
        self._called_here = self._called(name)
        own_text = store.generate_msgdef(self._called_here, ros_version=2)[0]
        self._types = defined(self._called_here, own_text)
        typestore.fields(self._called_here, self._types)  # raises what is wrong with them
        self._values = self._values_of(name)

    def fits(self, cdr: bytes) -> bool:
        """Return whether a message consists of just the fields of this type."""
        return is_whole(self._called_here, cdr, self._types)

    def to_cdr(self, cdr: bytes) -> bytes:
        """Return a message of the type that is known here.

        Raises:
            DecodeError: the bytes are not a message of this type.
            EncodeError: a value does not fit the type that is known here.
        """
        return encode(self.name, self._values(decode(self._called_here, cdr, self._types)))

    def _outer(self) -> set[str]:
        """Return the types with a field of a type that differs."""
        return {
            key
            for key, own in self._fields.items()
            if any(field.is_message and field.base in self._differs for field in own)
        }

    def _called(self, name: str) -> str:
        package, _, own = name.rpartition("/")
        return f"{package}/{_OTHER}{own}" if name in self._differs else name

    def _renamed(self, kind: Nodetype, value: Any) -> Any:
        if kind == Nodetype.NAME:
            return kind, self._called(value)
        if kind in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            inner, size = value
            return kind, (self._renamed(*inner), size)
        return kind, value

    def _values_of(self, name: str) -> _Values:
        """Return what takes the values of a message; those of types that do not differ stay."""
        if name not in self._differs:
            return lambda message: message
        names = {field.name for field in typestore.fields(name)}
        readers = [
            (field.name, attribute(field.name), self._value_of(field))
            for field in self._fields[name]
            if field.name in names
        ]

        def values(message: Any) -> Mapping[str, Any]:
            return {key: take(getattr(message, own)) for key, own, take in readers}

        return values

    def _value_of(self, field: MessageField) -> _Values:
        if not field.is_message or field.base not in self._differs:
            return lambda value: value
        one = self._values_of(field.base)
        return one if field.size is None else lambda several: [one(each) for each in several]


class UndefinedMessages:
    """Messages of a type that came without its definition, from some distribution.

    The first message that says more than that it is empty decides which distribution's it is.

    Args:
        name: full name of the type.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._is_known = False
        """They are of the type that is known here."""
        self._layout: OtherLayout | None = None

    def to_cdr(self, cdr: bytes) -> bytes:
        """Return a message of the type that is known here; as it is if no definition fits it."""
        if self._is_known:
            return cdr
        if self._layout is None:
            if is_whole(self._name, cdr):
                self._is_known = len(cdr) > len(encode(self._name))
                return cdr
            self._layout = next((each for each in layouts(self._name) if each.fits(cdr)), None)
        try:
            return cdr if self._layout is None else self._layout.to_cdr(cdr)
        except MessageError:
            return cdr


def may_differ(type_name: str) -> bool:
    """Return whether a type that is known here, or one that it contains, has changed since Foxy."""
    if not typestore.type_exists(type_name):
        return False
    known_types, reached = typestore.KNOWN, dict[str, Extent]()
    extent(type_name, lambda key: (known_types.get(key) or (0, None))[1], reached)
    return not CHANGED.isdisjoint(reached)


def definition_elsewhere(type_name: str) -> str:
    """Return the definition of a type that is unknown here, "" if no distribution has it."""
    return next(_definitions(type_name), "")


@cache
def layouts(type_name: str) -> tuple[OtherLayout, ...]:
    """Return the layouts of a type in other distributions, the newest first."""
    other_layouts = []
    for text in dict.fromkeys(_definitions(type_name)):
        with contextlib.suppress(DefinitionError):  # it became another type
            other_layouts.append(OtherLayout(type_name, text))
    return tuple(other_layouts)


def _definitions(type_name: str) -> Iterator[str]:
    for each in _STORES:
        store = get_typestore(each)
        if type_name in store.fielddefs:
            yield store.generate_msgdef(type_name, ros_version=2)[0]


def _differs(name: str, own: list[MessageField]) -> bool:
    """Return whether a type has other fields than the one that is known here.

    Raises:
        DefinitionError: it has not just more or fewer of them.
    """
    if not typestore.type_exists(name) or own == (own_fields := typestore.fields(name)):
        return False
    ours, theirs = ({field.name: field for field in each} for each in (own_fields, own))
    common = ours.keys() & theirs.keys()
    if any(ours[key] != theirs[key] for key in common) or len(common) < min(len(ours), len(theirs)):
        raise DefinitionError(f"{name} differs from ROS 2's in types of fields. Rename the type.")
    return True
