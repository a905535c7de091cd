"""Reading of .msg text, in time that grows with its length alone.

The grammar is that of https://docs.ros.org/en/jazzy/Concepts/Basic/About-Interfaces.html; names and
constants of ROS 1 are read, too.
"""

from __future__ import annotations

import re
from typing import Literal

from rosbags.interfaces import Nodetype

Value = bool | int | float | str
One = tuple[Literal[Nodetype.BASE], tuple[str, int]] | tuple[Literal[Nodetype.NAME], str]
"""Description of one value: a primitive with the bound of a string, or a type."""
Description = (
    One
    | tuple[Literal[Nodetype.ARRAY], tuple[One, int]]
    | tuple[Literal[Nodetype.SEQUENCE], tuple[One, int]]
)
"""Description of a field, with the length of an array or the bound of a sequence."""
Types = dict[str, tuple[list[tuple[str, str, Value]], list[tuple[str, Description]]]]
"""Constants (name, type, value) and fields (name, description) by type, as rosbags has them."""

MAX_DIGITS = 40
"""Largest number of digits of a number. Python takes the square of their count to read them."""
MAX_NAME = 255
"""Characters of the name of a type or a field, as ROS allows."""
MAX_SIZE = (1 << 32) - 1
"""Limit of the size of an array, and of the bound of a sequence or a string."""
PRIMITIVES = frozenset(
    {"bool", "byte", "char", "string", "wstring", "float32", "float64"}
    | {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
)
_NAMES = {
    "time": "builtin_interfaces/msg/Time",
    "duration": "builtin_interfaces/msg/Duration",
    "Header": "std_msgs/msg/Header",
}
_SEPARATOR = "=" * 80
_HEAD = re.compile(r"MSG: ([A-Za-z0-9/_]+)[ \t]*", re.ASCII)
_LINE = re.compile(
    r"""[ \t]*(?:@[a-z]+[ \t]+)*
    (?P<type>[A-Za-z]\w*(?:/[A-Za-z]\w*)*)
    (?:<=(?P<longest>[0-9]+))?
    (?:\[(?P<at_most><=)?(?P<size>[0-9]*)\])?
    [ \t]+(?P<name>[A-Za-z]\w*)
    (?:[ \t]*=[ \t]*(?P<value>.*)|[ \t]+[^= \t].*|[ \t]*(?:\#.*)?)""",
    re.ASCII | re.VERBOSE,
)
_BLANK = re.compile(r"[ \t]*(?:@[a-z]+[ \t]*)*(?:#.*)?", re.ASCII)
_FLOAT = re.compile(
    r"[+-]?(?:[0-9]+\.[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|[+-]?[0-9]+[eE][+-]?[0-9]+"
)
_INTEGER = re.compile(r"[+-]?(?:0[xX][0-9a-fA-F]+|0[bB][01]+|[0-9]+)")
_QUOTED = re.compile(r"""(?:'((?:\\.|[^'\\])*)'|"((?:\\.|[^"\\])*)")[ \t]*(?:\#.*)?""")


class TextError(ValueError):
    """A definition is invalid; the message is a clause that says where."""


def types_in_msg(text: str, name: str) -> Types:
    """Return the types in .msg text.

    Args:
        text: of the type, and of others after lines of "=" and "MSG: package/Type".
        name: of the first type.

    Raises:
        TextError: the text is invalid.
    """
    constants: list[tuple[str, str, Value]] = []
    fields: list[tuple[str, Description]] = []
    current = name_in_text(name)
    types: Types = {current: (constants, fields)}
    is_head = False
    for number, raw in enumerate(text.split("\n"), 1):
        line = raw.rstrip("\r")
        if is_head:
            if (head := _HEAD.fullmatch(line)) is None or len(head[1]) > MAX_NAME:
                raise TextError(f"line {number} does not name a type")
            constants, fields, current = [], [], name_in_text(head[1])
            types[current] = constants, fields
            is_head = False
        elif line == _SEPARATOR:
            is_head = True
        elif (match := _LINE.fullmatch(line)) is not None:
            type_, longest, at_most, size, field, value = match.groups()
            if max(len(type_), len(field)) > MAX_NAME:
                raise TextError(f"line {number} has a name of more than {MAX_NAME} characters")
            if value is not None:
                if type_ not in PRIMITIVES or longest or size is not None:
                    raise TextError(f"line {number} is not a constant")
                constants.append((field, type_, _value(type_, value, number)))
            else:
                fields.append((field, _described(current, type_, longest, at_most, size, number)))
        elif _BLANK.fullmatch(line) is None:
            raise TextError(f"line {number} is not a field")
    if is_head:
        raise TextError("its last type has no name")
    return types


def name_in_text(name: str) -> str:
    """Return the name of a type with its folder."""
    package, slash, short = name.rpartition("/")
    is_full = package.rpartition("/")[2] in ("msg", "action")
    return name if is_full or not slash else f"{package}/msg/{short}"


def _described(
    owner: str, type_: str, longest: str | None, at_most: str | None, size: str | None, line: int
) -> Description:
    """Return the description of a field."""
    if longest is not None and type_ not in ("string", "wstring"):
        raise TextError(f"line {line} bounds a type that is not a string")
    one: One
    if type_ in PRIMITIVES:
        one = Nodetype.BASE, (type_, _sized(longest or "0", 0, line))
    else:
        one = Nodetype.NAME, _referred(owner, _NAMES.get(type_, type_))
    if size is None:
        return one
    if size and not at_most:
        return Nodetype.ARRAY, (one, _sized(size, 1, line))
    return Nodetype.SEQUENCE, (one, _sized(size or "0", 1 if at_most else 0, line))


def _referred(owner: str, name: str) -> str:
    """Return the full name of a type that a field of another one has."""
    if "/" not in name:
        return f"{owner.rpartition('/')[0]}/{name}"
    return name if "/msg/" in name or "/action/" in name else name_in_text(name)


def _sized(digits: str, least: int, line: int) -> int:
    """Return the size of an array, or a bound."""
    size = int(digits) if len(digits) <= MAX_DIGITS else MAX_SIZE + 1
    if not least <= size <= MAX_SIZE:
        raise TextError(f"line {line} has an invalid size")
    return size


def _value(type_: str, text: str, line: int) -> Value:
    """Return the value of a constant; what is no number of its type stays a text."""
    if type_ in ("string", "wstring"):
        quoted = _QUOTED.fullmatch(text)
        return (quoted[1] or quoted[2] or "") if quoted else text.rstrip(" \t")
    plain = text.partition("#")[0].rstrip(" \t")
    if not plain:
        raise TextError(f"line {line} has no value")
    if len(plain) > MAX_DIGITS and (_INTEGER.fullmatch(plain) or _FLOAT.fullmatch(plain)):
        raise TextError(f"line {line} has a number of more than {MAX_DIGITS} digits")
    if plain.lower() in ("true", "false"):
        return plain.lower() == "true"
    if _FLOAT.fullmatch(plain):
        return float(plain)
    if _INTEGER.fullmatch(plain):
        return integer(plain)
    return plain


def integer(text: str) -> int:
    """Return an integer in the notation of C."""
    digits = text.lstrip("+-")
    if not digits.isdecimal():
        return int(text, 0)
    is_octal = len(digits) > 1 and digits[0] == "0" and not set(digits) & {"8", "9"}
    return int(text, 8 if is_octal else 10)
