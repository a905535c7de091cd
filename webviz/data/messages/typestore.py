"""The known message types and their layout.

rosbags knows the ROS 2 core interfaces and parses .msg text. Only its definitions are used, never
the code that it generates from them, because definitions may come from untrusted publishers.
"""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Collection, Container
from functools import _lru_cache_wrapper, cache, cached_property, lru_cache
from typing import Any, NamedTuple, TypeVar

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore

from webviz.data.messages import definitions
from webviz.data.messages.errors import DefinitionError, UnknownTypeError
from webviz.data.messages.extents import Extent, extent
from webviz.data.messages.idl_text import types_in_idl
from webviz.data.messages.msg_text import (
    Description,
    TextError,
    Types,
    Value,
    types_in_msg,
)

MAX_TEXT = 1 << 20
"""Characters of a definition with all its nested types; the longest of ROS have a tenth of it.
Reading them takes up to two seconds."""
MAX_TYPES = 1000
"""Largest number of types of a definition, those that its messages consist of; those of ROS have
80. Making the class of each takes 0.2 ms."""
MAX_CACHED = 10_000
"""Results of a function that follow from definitions; a large robot has a thousand types."""
MAX_NAMES = 10_000
"""Largest number of names of types that are remembered as valid; a large robot has a thousand."""
PLACEHOLDER: tuple[str, Description] = (
    "structure_needs_at_least_one_member",
    (Nodetype.BASE, ("uint8", 0)),
)
"""The field of messages without fields: IDL has no empty structure, so rosidl adds it."""
_IDL = re.compile(r"^={80}\nIDL: \S+$", re.MULTILINE)
"""Precedes each IDL file of a definition."""
_TYPE_NAME = re.compile(r"[A-Za-z]\w*/(?:msg|srv|action)/[A-Za-z]\w*", re.ASCII)


_finders: list[Callable[[str], object]] = []
_cached: list[_lru_cache_wrapper[Any]] = []
_lock = threading.RLock()
"""Held while definitions or what is known of them change."""

R = TypeVar("R")


def per_definitions(function: Callable[..., R]) -> _lru_cache_wrapper[R]:
    """Cache the results of a function until a definition changes; its last argument is `types`."""
    _cached.append(cached := lru_cache(MAX_CACHED)(function))
    return cached


class MessageField(NamedTuple):
    """One field of a message.

    Attributes:
        name: As in the .msg file.
        base: Name of a primitive ("float32", "string") or of a message type.
        is_message: Whether `base` is a message type.
        size: None for a single value, 0 for a sequence, else the length of a fixed array.
        most: Elements that a sequence may have, 0 for any number.
        longest: Bytes that a string may have, 0 for any number.
    """

    name: str
    base: str
    is_message: bool
    size: int | None
    most: int = 0
    longest: int = 0


@cache
def _store() -> Any:
    return get_typestore(Stores.ROS2_JAZZY)


class KnownTypes:
    """The message types of this process, which publishers add and replace."""

    def __init__(self) -> None:
        self.extents: dict[str, Extent] = {}
        """Extents of the types that were asked for."""

    def get(self, name: str) -> Any:
        """Return the definition of a type by its full name, None if there is none.

        Those of `definitions` are read when they are needed: all of them take a tenth of a start.
        """
        defs = _store().fielddefs
        if name not in defs and "/msg/" in name and (text := definitions.text(name)):
            parsed = types_in_msg(text, name)[name]
            for field in filter(lambda field: field.is_message, fields_of(parsed)):
                self.get(field.base)  # they are looked for in the store
            defs[name] = parsed
        return defs.get(name)


KNOWN = KnownTypes()


class DefinedTypes:
    """The message types of one definition, such as that of a channel in a recording or bridge.

    They are read when they are needed, and stay as they are, whatever else has their names.

    Args:
        type_name, text: see `webviz.data.messages.register`.
        fixed: names of types that the definition must define as this process does.
    """

    def __init__(self, type_name: str, text: str, fixed: Container[str]) -> None:
        self.extents: dict[str, Extent] = {}
        self.text = text
        self._source = full_name(type_name), text, fixed

    def get(self, name: str) -> Any:
        """Return the definition of a type by its full name, None if it has none.

        Raises:
            DefinitionError: the text is invalid; see `webviz.data.messages.register`.
        """
        if isinstance(self._types, str):
            raise DefinitionError(self._types)
        return self._types.get(name)

    @cached_property
    def _types(self) -> Types | str:
        """The types, or why there are none."""
        try:
            learnt, reached = _learnt(*self._source)
        except DefinitionError as error:
            return str(error)
        return {name: learnt.get(name) or KNOWN.get(name) for name in reached}


MessageTypes = KnownTypes | DefinedTypes


@lru_cache(MAX_NAMES)
def full_name(type_name: str) -> str:
    """Return the three-part name of a type: "std_msgs/String" becomes "std_msgs/msg/String".

    Raises:
        UnknownTypeError: `type_name` is not the name of a ROS 2 type.
    """
    full = type_name if type_name.count("/") != 1 else type_name.replace("/", "/msg/")
    if not _TYPE_NAME.fullmatch(full):
        raise UnknownTypeError(
            f"{type_name!r} is not a valid message type, such as sensor_msgs/msg/LaserScan."
        )
    return full


def find_with(finder: Callable[[str], object]) -> None:
    """Let a function register types whose definition is missing, such as those of a ROS workspace.

    Args:
        finder: called with the full name of a message, service or action type, in any thread; it
            raises a `MessageError` if webviz cannot read the type. It is asked before those that
            were added earlier.
    """
    if finder not in _finders:
        _finders.insert(0, finder)


def find(type_name: str) -> None:
    """Register a type whose definition is missing, if a finder has it."""
    for finder in _finders:
        finder(full_name(type_name))


def type_exists(type_name: str) -> bool:
    """Return whether a definition of this type is known."""
    try:
        return KNOWN.get(full_name(type_name)) is not None
    except UnknownTypeError:
        return False


def fields(type_name: str, types: MessageTypes = KNOWN) -> list[MessageField]:
    """Return the fields of a type in the order of the wire.

    Args:
        type_name: such as "std_msgs/msg/Header".
        types: that define it.

    Raises:
        UnknownTypeError: No definition of the type is known.
        DefinitionError: Types that it contains have been replaced by others that do not fit.
    """
    return fields_of(_definition(type_name, types))


def fields_in(type_name: str, text: str) -> list[MessageField]:
    """Return the fields of a type by its full name in a definition, which is not registered.

    Raises:
        DefinitionError: as `types_in`.
    """
    return fields_of(types_in(type_name, text)[type_name])


def constants(type_name: str, types: MessageTypes = KNOWN) -> dict[str, bool | int | float | str]:
    """Return the constants of a type, such as `ARROW` of a marker; see `fields`.

    Raises:
        UnknownTypeError: No definition of the type is known.
    """
    return {name: value for name, _, value in typed_constants(type_name, types)}


def typed_constants(type_name: str, types: MessageTypes = KNOWN) -> list[tuple[str, str, Value]]:
    """Return name, type and value of the constants of a type; see `constants`."""
    return _definition(type_name, types)[0]


def definition(type_name: str, types: MessageTypes = KNOWN) -> str:
    """Return the .msg text of a type, followed by those of its nested types, as bags store it.

    Args:
        type_name: such as "std_msgs/msg/Header".
        types: that define it; of one definition, that is returned as it came.

    Raises:
        UnknownTypeError: No definition of the type is known.
    """
    if isinstance(types, DefinedTypes):
        return types.text
    _definition(type_name)
    return _store().generate_msgdef(full_name(type_name), ros_version=2)[0]


def type_hash(type_name: str) -> str:
    """Return the hash by which ROS 2 distinguishes versions of a type (REP 2016), "RIHS01_...".

    Raises:
        UnknownTypeError: No definition of the type is known.
    """
    _definition(type_name)
    return _store().hash_rihs01(full_name(type_name))


def is_idl(text: str) -> bool:
    """Return whether a definition is in IDL, not .msg text."""
    return bool(_IDL.search(text))


def add(type_name: str, text: str, fixed: Container[str]) -> None:
    """Register a type from its .msg text or IDL, but never change those in `fixed`.

    See `webviz.data.messages.register`.
    """
    with _lock:
        _learn(_learnt(full_name(type_name), text, fixed)[0])


def _learnt(name: str, text: str, fixed: Container[str]) -> tuple[Types, Collection[str]]:
    """Return those types in a definition of which its type consists, and the names of all."""
    all_types = types_in(name, text)
    reached: dict[str, Extent] = {}
    extent(name, lambda key: (all_types.get(key) or KNOWN.get(key) or (None, None))[1], reached)
    if len(reached) > MAX_TYPES:
        raise DefinitionError(f"{name} consists of more than {MAX_TYPES} types.")
    learnt = {key: all_types[key] for key in reached if key in all_types}
    for key in learnt:
        if key in fixed and fields_of(learnt[key]) != fields(key):
            raise DefinitionError(
                f"The definition of {name} contains a {key} that differs from ROS 2's."
            )
    return learnt, reached


def types_in(name: str, text: str) -> Types:
    """Return the types in a definition, those without fields with `PLACEHOLDER`.

    Args:
        name: the type that it defines.
        text: .msg text, or IDL files, each after a line of "=" and "IDL: pkg/msg/Type".

    Raises:
        DefinitionError: it is invalid or longer than `MAX_TEXT`.
    """
    all_types = parsed(name, text)
    return {key: (values, own or [PLACEHOLDER]) for key, (values, own) in all_types.items()}


def parsed(name: str, text: str) -> Types:
    """Return the types in a definition as they are there; see `types_in`.

    This is the only way by which definitions come in. It takes time that grows with their length
    alone, and raises nothing but `DefinitionError`.
    """
    if len(text) > MAX_TEXT:
        raise DefinitionError(f"The definition of {name} is longer than {MAX_TEXT >> 20} MB.")
    language = "IDL" if is_idl(text) else ".msg text"
    try:
        if language == "IDL":
            files = filter(str.strip, _IDL.split(text))
            types = {key: each for file in files for key, each in types_in_idl(file).items()}
        else:
            types = types_in_msg(text, name)
    except TextError as error:
        raise DefinitionError(
            f"The definition of {name} is not valid {language}: {error}."
        ) from error
    if name not in types:  # such as that of a service
        raise DefinitionError(f"The definition of {name} does not define it.")
    return types


def declare(type_name: str, described: list[Any]) -> None:
    """Register a type that consists of others, such as a part of an action.

    Args:
        type_name: its full name.
        described: name and kind of each field, as `rosbags.typesys` describes them; without any,
            it gets `PLACEHOLDER`.
    """
    with _lock:
        _learn({type_name: ([], described or [PLACEHOLDER])})


def weight(type_name: str, types: MessageTypes = KNOWN) -> int:
    """Return what a message of this type counts as among the elements of a sequence.

    Raises:
        MessageError: as `fields`.
    """
    _definition(type_name, types)
    with _lock:
        return _extent(full_name(type_name), types).weight


def described(type_name: str) -> list[Any]:
    """Name and kind of each field of a type, with bounds, as `rosbags.typesys` describes them.

    Raises:
        UnknownTypeError: No definition of the type is known.
    """
    return _definition(type_name)[1]


def _definition(type_name: str, types: MessageTypes = KNOWN) -> Any:
    name = full_name(type_name)
    if types is KNOWN and KNOWN.get(name) is None:
        find(name)
    if (type_definition := types.get(name)) is None:
        raise UnknownTypeError(f"No definition of the message type {type_name} is known.")
    if name not in types.extents:
        with _lock:
            _extent(name, types)
    return type_definition


def _extent(name: str, types: MessageTypes) -> Extent:
    """Return the extent of a type; those in it may have been replaced since it was registered."""
    return extent(name, lambda key: (types.get(key) or (None, None))[1], types.extents)


def _learn(types: Types) -> None:
    """Take types, and forget what follows from those that they replace."""
    defs = _store().fielddefs
    is_replaced = any(KNOWN.get(name) not in (None, own) for name, own in types.items())
    defs.update(types)
    if is_replaced:
        KNOWN.extents.clear()
        for cached in _cached:
            cached.cache_clear()


def fields_of(definition: Any) -> list[MessageField]:
    """Return the fields of a type as `types_in` has it."""
    return [_field(name, *description) for name, description in definition[1]]


def _field(name: str, kind: Nodetype, value: Any) -> MessageField:
    size, most = None, 0
    if kind == Nodetype.ARRAY:
        (inner, base), size = value
    elif kind == Nodetype.SEQUENCE:
        (inner, base), most = value
        size = 0
    else:
        inner, base = kind, value
    is_message = inner == Nodetype.NAME
    if is_message:
        return MessageField(name, base, True, size, most)
    return MessageField(name, base[0], False, size, most, base[1])
