"""The known message types and their layout.

rosbags knows the ROS 2 core interfaces and parses .msg text. Only its definitions are used, never
the code that it generates from them, because definitions may come from untrusted publishers.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container
from functools import cache
from typing import Any, NamedTuple

from rosbags.interfaces import Nodetype
from rosbags.typesys import (
    Stores,
    TypesysError,
    get_types_from_idl,
    get_types_from_msg,
    get_typestore,
)

from webviz.data.messages.definitions import DEFINITIONS
from webviz.data.messages.errors import DefinitionError, MessageError, UnknownTypeError

_IDL = re.compile(r"^={80}\nIDL: \S+$", re.MULTILINE)
"""Precedes each IDL file of a definition."""
_PREPROCESSOR = re.compile(r"^[ \t]*#.*$", re.MULTILINE)
"""Lines that rosbags does not read; what they include follows in the definition."""
MAX_FIELDS = 20_000
"""Of a message, those of nested messages included, each counted once in an array."""
_TYPE_NAME = re.compile(r"[A-Za-z]\w*/(?:msg|srv|action)/[A-Za-z]\w*", re.ASCII)


_finders: list[Callable[[str], object]] = []


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


def _known(name: str) -> Any:
    """Return the definition of a type by its full name, None if there is none.

    Those of `DEFINITIONS` are parsed when they are needed: all of them take a tenth of a start.
    """
    known = _store().fielddefs
    if name not in known and name in DEFINITIONS:
        parsed = get_types_from_msg(DEFINITIONS[name], name)[name]
        for field in filter(lambda field: field.is_message, _fields_of(parsed)):
            _known(field.base)  # they are looked for in the store
        known[name] = parsed
    return known.get(name)


@cache
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
            raises a `MessageError` if webviz cannot read the type.
    """
    if finder not in _finders:
        _finders.append(finder)


def find(type_name: str) -> None:
    """Register a type whose definition is missing, if somebody knows it."""
    for finder in _finders:
        finder(full_name(type_name))


def type_exists(type_name: str) -> bool:
    """Return whether messages of this type can be decoded."""
    try:
        return _known(full_name(type_name)) is not None
    except UnknownTypeError:
        return False


def fields(type_name: str) -> list[MessageField]:
    """Return the fields of a type in the order of the wire.

    Raises:
        UnknownTypeError: No definition of the type is known.
    """
    return _fields_of(_definition(type_name))


def constants(type_name: str) -> dict[str, bool | int | float | str]:
    """Return the constants of a type, such as `ARROW` of a marker.

    Raises:
        UnknownTypeError: No definition of the type is known.
    """
    return {name: value for name, _, value in _definition(type_name)[0]}


def definition(type_name: str) -> str:
    """Return the .msg text of a type, followed by those of its nested types, as bags store it.

    Raises:
        UnknownTypeError: No definition of the type is known.
    """
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


def are_same(type_name: str, text: str, other: str) -> bool:
    """Return whether two definitions are of the same type; those that are invalid are not."""
    name = full_name(type_name)
    try:
        first, second = _types_in(name, text), _types_in(name, other)
    except TypesysError:
        return False
    return first == second


def add(type_name: str, text: str, fixed: Container[str]) -> None:
    """Register a type from its .msg text or IDL, but never change those in `fixed`.

    See `webviz.data.messages.register`.
    """
    name = full_name(type_name)
    try:
        learnt = _types_in(name, text)
    except TypesysError as error:  # its text quotes the whole definition
        language = "IDL" if is_idl(text) else ".msg text"
        raise DefinitionError(f"The definition of {name} is not valid {language}.") from error
    if name not in learnt:  # such as that of a service
        raise DefinitionError(f"The definition of {name} does not define it.")
    known = _store().fielddefs
    for key in learnt:
        if key in fixed and _fields_of(learnt[key]) != fields(key):
            raise DefinitionError(
                f"The definition of {name} contains a {key} that differs from ROS 2's."
            )
    before = {key: known[key] for key in learnt if key in known}
    known.update(learnt)
    try:
        _check(name, (), {})
    except (MessageError, RecursionError):
        for key in learnt:
            del known[key]
        known.update(before)
        raise


def _types_in(name: str, text: str) -> dict[str, Any]:
    """Return the types in a definition; raises TypesysError."""
    return _types_from_idl(text) if is_idl(text) else get_types_from_msg(text, name)


def _types_from_idl(text: str) -> dict[str, Any]:
    """Return the types in IDL files, each after a line of "=" and "IDL: pkg/msg/Type"."""
    found: dict[str, Any] = {}
    for file in filter(str.strip, _IDL.split(_PREPROCESSOR.sub("", text))):
        found |= get_types_from_idl(file)
    return found


def declare(type_name: str, described: list[Any]) -> None:
    """Register a type that consists of others, such as a part of an action.

    Args:
        type_name: its full name.
        described: name and kind of each field, as `rosbags.typesys` describes them.
    """
    _store().fielddefs[type_name] = ([], described)


def described(type_name: str) -> list[Any]:
    """Name and kind of each field of a type, with bounds, as `rosbags.typesys` describes them.

    Raises:
        UnknownTypeError: No definition of the type is known.
    """
    return _definition(type_name)[1]


def _check(type_name: str, inside: tuple[str, ...], counts: dict[str, int]) -> int:
    """Return the number of fields of a type, those of its messages included.

    Args:
        type_name: of the type.
        inside: types that contain it.
        counts: those that are known, by type.

    Raises:
        DefinitionError: a type that it contains is unknown or contains itself, or the fields are
            more than `MAX_FIELDS`: types that contain others twice have 2^n of them.
    """
    if type_name in counts:
        return counts[type_name]
    if type_name in inside:
        raise DefinitionError(f"{type_name} cannot contain itself.")
    if _known(type_name) is None:
        raise DefinitionError(f"{inside[-1]} contains a {type_name}, whose definition is missing.")
    count = 0
    for field in fields(type_name):
        count += 1
        if field.is_message:
            count += _check(field.base, (*inside, type_name), counts)
        if count > MAX_FIELDS:
            raise DefinitionError(f"{type_name} has more than {MAX_FIELDS} fields in all.")
    counts[type_name] = count
    return count


def _definition(type_name: str) -> Any:
    name = full_name(type_name)
    if _known(name) is None:
        find(name)
    if (found := _known(name)) is None:
        raise UnknownTypeError(f"No definition of the message type {type_name} is known.")
    return found


def _fields_of(definition: Any) -> list[MessageField]:
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
