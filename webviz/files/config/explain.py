"""msgspec's errors in the words of configs."""

from __future__ import annotations

import json
import re
import types
import typing
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

import msgspec

from webviz.api.declared import Declared, Topic, make
from webviz.api.properties import bare, properties_of
from webviz.data.words import joined
from webviz.files.config.errors import nearest
from webviz.files.config.source import Location, Path

MAX_LENGTH = 60
"""Characters of a value shown in an error."""
MAX_MISTAKES = 10

WORDS = {
    "float": "a number",
    "int": "a whole number",
    "bool": "true or false",
    "str": "text",
    "array": "a list",
    "object": "keys with values",
}
_STEP = re.compile(r"\.(?P<key>\w+)|\[(?P<index>\d+)\]|\[\.\.\.\]")
_BOUND = re.compile(r"Expected `[^`]*` ([<>]=?) (\S+)")
_LENGTH = re.compile(r"Expected `(?:array|str)` of length (?:(<=) )?(\d+)")
_PATTERN = "Expected `str` matching regex "
_TYPE = re.compile(r"Expected `([^`]*)`, got `[^`]*`")
_UNKNOWN = re.compile(r"Object contains unknown field `(.*)`")
_MISSING = re.compile(r"Object missing required field `(.*)`")


def explain(error: msgspec.ValidationError, hint: Any, values: Any) -> tuple[Path, str]:
    """The place of an invalid value, and what was expected.

    Args:
        error: of converting `values` to `hint`.
        hint: a type, such as a display's class.
        values: plain values, as in a config file.

    Returns:
        The path from `values`, and a clause such as "expected > 0, got -1".
    """
    text, _, where = str(error).partition(" - at `")
    steps = where.removesuffix("`").rpartition("` in `")[2]
    path, inner, value = _followed(steps, hint, values)
    if text.startswith("Invalid value "):  # of the key that tells structs apart
        path, inner, _ = _followed(steps.rpartition(".")[0], hint, values)
        tags = [each.__struct_config__.tag for each in _members(inner)]
        return (*path, steps.rpartition(".")[2]), _no_choice(value, tags)
    inner = _plain(inner, value)
    if "` - at `key` in `" in str(error):
        return path, 'expected text as keys, such as "0":'
    if found := _UNKNOWN.match(text):
        return (*path, found[1]), unknown_key(found[1], _fields(inner))
    return path, _clause(text, inner, value)


def unknown_key(key: str, valid: Iterable[str]) -> str:
    """The error for an unknown key."""
    return f"unknown key, {nearest(key, valid)}"


def mistakes(
    cls: type[Declared],
    values: Mapping[str, Any],
    error: msgspec.ValidationError,
    others: Iterable[str] = (),
) -> list[tuple[Path, str]]:
    """All errors in the properties of a display or tool, each with its path and a clause.

    Args:
        cls: of the display or tool.
        values: plain values, as in a config file.
        error: of making it; it names only the first mistake.
        others: keys that are valid without being properties.
    """
    fields = [*cls.__struct_fields__, *others]
    found: list[tuple[Path, str]] = []
    for key, value in values.items():
        if key not in fields:
            found.append(((key,), unknown_key(key, fields)))
        elif key not in others:
            try:
                make(cls, {key: value})
            except msgspec.ValidationError as single:
                found.append(explain(single, cls, {key: value}))
    return found or [explain(error, cls, values)]  # the values may contradict each other


def sentences(found: Sequence[tuple[Path, str]], place: Location = Location()) -> str:  # noqa: B008
    """Errors with their places, up to a limit."""
    told = [place.at(*path).says(clause) for path, clause in found[:MAX_MISTAKES]]
    if len(found) > MAX_MISTAKES:
        told.append(f"{len(found) - MAX_MISTAKES} more errors.")
    return joined(*told)


def shown(value: Any) -> str:
    """A value as written in a config file, shortened."""
    if value is None:
        return "nothing"
    if isinstance(value, str):
        return f"`{_short(value)}`"
    if isinstance(value, float):
        return f"{value:g}"
    return _short(json.dumps(value, default=str, ensure_ascii=False))


def _short(text: str) -> str:
    text = "".join(letter if letter.isprintable() else " " for letter in text)
    return text if len(text) <= MAX_LENGTH else f"{text[: MAX_LENGTH - 1]}…"


def _followed(steps: str, hint: Any, value: Any) -> tuple[Path, Any, Any]:
    """A path of msgspec as keys and indices, with the type and the value at that path."""
    path: Path = ()
    for step in _STEP.finditer(steps):
        plain = _plain(hint, value)
        if step["key"]:
            key: str | int = step["key"]
        elif step["index"]:
            key = int(step["index"])
        else:
            key = _misfit(plain, value)
        path = (*path, key)
        hint = _inner(plain, key)
        try:
            value = value[key]
        except (KeyError, IndexError, TypeError):
            value = msgspec.UNSET
    return path, hint, value


def _plain(hint: Any, value: Any = None) -> Any:
    """A type without annotations and None; of several structs the one that a value's tag names."""
    hint = bare(hint)
    parts = typing.get_args(hint)
    if len(parts) == 2 and types.NoneType in parts:
        hint = bare(parts[parts[0] is types.NoneType])
    structs = _members(hint)
    for each in structs if isinstance(value, Mapping) else ():
        if value.get(each.__struct_config__.tag_field) == each.__struct_config__.tag:
            return each
    return structs[0] if structs else hint


def _members(hint: Any) -> list[type[msgspec.Struct]]:
    """The structs of a union, which a tag tells apart, or the one struct."""
    parts = typing.get_args(hint) if isinstance(hint, types.UnionType) else (hint,)
    return [each for each in parts if isinstance(each, type) and issubclass(each, msgspec.Struct)]


def _inner(hint: Any, key: str | int) -> Any:
    """The type of what is at a key of a type."""
    if isinstance(hint, type) and issubclass(hint, msgspec.Struct):
        return next((each.hint for each in properties_of(hint) if each.path == key), None)
    parts = typing.get_args(hint)
    match typing.get_origin(hint):
        case origin if origin is dict:
            return parts[1]
        case origin if origin is list:
            return parts[0]
        case origin if origin is tuple and isinstance(key, int):
            return parts[min(key, len(parts) - 1)]
    return None


def _misfit(hint: Any, values: Any) -> str:
    """The first key with an invalid value; msgspec does not report keys of mappings."""
    for key, value in values.items() if isinstance(values, Mapping) else ():
        try:
            msgspec.convert({key: value}, hint)
        except msgspec.ValidationError:
            return str(key)
    return "..."


def _clause(text: str, hint: Any, value: Any) -> str:
    got = _got(value)
    if found := _BOUND.match(text):
        return f"expected {found[1]} {float(found[2]):g}{got}"
    if found := _LENGTH.match(text):
        unit = "characters" if isinstance(value, str) else "values"
        return f"expected {'at most ' * bool(found[1])}{found[2]} {unit}{got}"
    if text.startswith(_PATTERN):
        return f"expected a name such as `/goal_pose` or `/nav/*`{got}"
    if found := _MISSING.match(text):
        return f"the key `{found[1]}` is missing"
    if typing.get_origin(hint) is Literal:
        return _no_choice(value, typing.get_args(hint))
    if found := _TYPE.match(text):
        return f"expected {_expected(found[1], hint)}{got}"
    return text[:1].lower() + text[1:]


def _no_choice(value: Any, choices: Iterable[Any]) -> str:
    *most, last = map(str, choices)
    expected = f"{', '.join(most)} or {last}" if most else last
    return f"expected {expected}{_got(value)}"


def _got(value: Any) -> str:
    return "" if value is msgspec.UNSET else f", got {shown(value)}"


def _expected(words: str, hint: Any) -> str:
    if hint is Topic:
        return "the name of a topic"
    if fields := _fields(hint):
        return f"keys such as `{fields[0]}:`"
    if typing.get_origin(hint) is tuple:
        items = typing.get_args(hint)
        return "a list" if Ellipsis in items else f"a list of {len(items)} numbers"
    return " or ".join(WORDS.get(word, word) for word in words.split(" | "))


def _fields(hint: Any) -> tuple[str, ...]:
    is_struct = isinstance(hint, type) and issubclass(hint, msgspec.Struct)
    return hint.__struct_fields__ if is_struct else ()
