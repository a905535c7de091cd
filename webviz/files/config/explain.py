"""Errors for invalid values, in the words of configs."""

from __future__ import annotations

import functools
import math
import operator
import re
import typing
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import msgspec
from msgspec.inspect import (
    AnyType,
    BoolType,
    DictType,
    FloatType,
    IntType,
    ListType,
    LiteralType,
    Metadata,
    NoneType,
    StrType,
    StructType,
    TupleType,
    Type,
    UnionType,
    VarTupleType,
    type_info,
)

from webviz.api.declared import Declared, Topic, completed, make
from webviz.api.properties import properties_of
from webviz.data.words import counted, joined
from webviz.files.config.errors import choices, excerpt, unknown_key
from webviz.files.config.source import Location, Path

MAX_MISTAKES = 10
BOUNDS: Sequence[tuple[str, str, Callable[[Any, Any], bool]]] = (
    ("gt", ">", operator.gt),
    ("ge", ">=", operator.ge),
    ("lt", "<", operator.lt),
    ("le", "<=", operator.le),
)

NAMES: Mapping[type[Type], str] = {
    FloatType: "a number",
    IntType: "a whole number",
    BoolType: "true or false",
    StrType: "text",
    ListType: "a list",
    VarTupleType: "a list",
    DictType: "keys with values",
    StructType: "keys with values",
    AnyType: "a value",
}
TEXT_AS_KEYS = 'expected text as keys, such as "0":'


class Fault(NamedTuple):
    """An invalid part.

    Args:
        path: keys and indices from the whole values.
        clause: about it, such as "expected > 0, got -1".
    """

    path: Path
    clause: str


def first_fault(hint: Any, values: Any) -> Fault | None:
    """Return the part at which `msgspec.convert(values, hint)` fails; None if it does not.

    msgspec reports it as an English sentence, without the keys of mappings on the way.

    Args:
        hint: a type, such as a display's class.
        values: plain values, as in a config file.
    """
    if isinstance(hint, type) and issubclass(hint, Declared) and isinstance(values, Mapping):
        values = completed(hint, values)
    return _fault(_info(hint), values, ())


@functools.cache
def _info(hint: Any) -> Type:
    return type_info(hint)


def _fault(type_: Type, value: Any, path: Path) -> Fault | None:
    match type_:
        case Metadata():
            return _fault(type_.type, value, path)
        case UnionType():
            fitting = next((each for each in type_.types if _has_kind(each, value)), None)
            if fitting is None:
                return _expected(" or ".join(map(_name, _parts(type_))), value, path)
            if isinstance(fitting, StructType) and fitting.tag is not None:
                return _tagged(_structs(type_), value, path)
            return _fault(fitting, value, path)
        case StructType() if type_.tag is not None and isinstance(value, Mapping):
            return _tagged([type_], value, path)
        case _ if not _has_kind(type_, value):
            return _expected(_name(type_), value, path)
        case StructType():
            return _in_struct(type_, value, path)
        case DictType():
            return _in_dict(type_, value, path)
        case ListType() | VarTupleType():
            return _size(type_, value, "values", path) or _first(
                _fault(type_.item_type, item, (*path, i)) for i, item in enumerate(value)
            )
        case TupleType():
            if len(value) != (count := len(type_.item_types)):
                return _expected(counted(count, "value"), value, path)
            pairs = zip(type_.item_types, value, strict=True)
            return _first(_fault(each, item, (*path, i)) for i, (each, item) in enumerate(pairs))
        case LiteralType() if value not in type_.values:
            return _expected(choices(type_.values), value, path)
        case IntType() | FloatType():
            return _number(type_, value, path)
        case StrType():
            return _text(type_, value, path)
    return None


def _tagged(structs: Sequence[StructType], value: Mapping[Any, Any], path: Path) -> Fault | None:
    """Return a struct of several that one of its keys tells apart."""
    key = structs[0].tag_field or ""
    if key not in value:
        if len(structs) == 1:
            return _in_struct(structs[0], value, path)
        return Fault(path, f"the key `{key}` is missing")
    named = next((each for each in structs if each.tag == value[key]), None)
    if named is None:
        return _expected(choices([each.tag for each in structs]), value[key], (*path, key))
    return _in_struct(named, value, path)


def _in_struct(type_: StructType, value: Mapping[Any, Any], path: Path) -> Fault | None:
    fields = {field.encode_name: field for field in type_.fields}
    hints = {each.path: each.hint for each in properties_of(type_.cls)}
    for key, item in value.items():
        if not isinstance(key, str):
            return Fault(path, TEXT_AS_KEYS)
        if key == type_.tag_field:
            continue
        if field := fields.get(key):
            if fault := _fault(_in_order(field.type, hints[field.name]), item, (*path, key)):
                return fault
        elif type_.forbid_unknown_fields:
            return Fault((*path, key), unknown_key(key, fields))
    for key, field in fields.items():
        if field.required and key not in value:
            return Fault(path, f"the key `{key}` is missing")
    if hasattr(type_.cls, "__post_init__"):
        try:
            msgspec.convert(value, type_.cls)
        except msgspec.ValidationError as error:  # in our own words
            return Fault(path, str(error.__cause__ or error))
    return None


def _in_order(type_: Type, hint: Any) -> Type:
    """Return a type whose choices are in the order of their declaration; msgspec sorts them."""
    match type_:
        case Metadata():
            return _in_order(type_.type, hint)
        case LiteralType():
            literals = [hint, *typing.get_args(hint)]
            chosen = next(each for each in literals if typing.get_origin(each) is typing.Literal)
            return LiteralType(typing.get_args(chosen))
        case UnionType():
            return UnionType(tuple(_in_order(each, hint) for each in type_.types))
    return type_


def _in_dict(type_: DictType, value: Mapping[Any, Any], path: Path) -> Fault | None:
    if not all(isinstance(key, str) for key in value):
        return Fault(path, TEXT_AS_KEYS)
    return _size(type_, value, "keys", path) or _first(
        _fault(type_.value_type, item, (*path, key)) for key, item in value.items()
    )


def _text(type_: StrType, value: Any, path: Path) -> Fault | None:
    if type_.pattern and not re.search(type_.pattern, value):
        return _expected("a name such as `/goal_pose` or `/nav/*`", value, path)
    return _size(type_, value, "characters", path)


def _number(type_: IntType | FloatType, value: Any, path: Path) -> Fault | None:
    if not math.isfinite(value):
        return _expected("a finite number", value, path)
    for name, sign, holds in BOUNDS:
        bound = getattr(type_, name)
        if bound is not None and not holds(value, bound):
            return _expected(f"{sign} {bound:g}", value, path)
    return None


def _size(
    type_: StrType | ListType | VarTupleType | DictType, value: Any, unit: str, path: Path
) -> Fault | None:
    if type_.max_length is not None and len(value) > type_.max_length:
        return _expected(f"at most {type_.max_length} {unit}", value, path)
    if type_.min_length is not None and len(value) < type_.min_length:
        return _expected(f"at least {type_.min_length} {unit}", value, path)
    return None


def _expected(what: str, value: Any, path: Path) -> Fault:
    return Fault(path, f"expected {what}, got {excerpt(value)}")


def _first(faults: Iterable[Fault | None]) -> Fault | None:
    return next((fault for fault in faults if fault), None)


def _parts(type_: UnionType) -> Sequence[Type]:
    """Return the types of a union; what may be left out is not asked for."""
    return [each for each in type_.types if not isinstance(each, NoneType)]


def _structs(type_: UnionType) -> list[StructType]:
    return [each for each in type_.types if isinstance(each, StructType)]


def _has_kind(type_: Type, value: Any) -> bool:
    """Return whether msgspec reads such a value as this type, apart from its content."""
    match type_:
        case Metadata():
            return _has_kind(type_.type, value)
        case NoneType():
            return value is None
        case BoolType():
            return isinstance(value, bool)
        case IntType():
            return isinstance(value, int) and not isinstance(value, bool)
        case FloatType():
            return isinstance(value, int | float) and not isinstance(value, bool)
        case StrType():
            return isinstance(value, str)
        case StructType() | DictType():
            return isinstance(value, Mapping)
        case ListType() | VarTupleType() | TupleType():
            return isinstance(value, list | tuple)
        case UnionType():
            return any(_has_kind(each, value) for each in type_.types)
    return True


def _name(type_: Type) -> str:
    """Return a type in words."""
    match type_:
        case Metadata():
            return _name(type_.type)
        case UnionType():
            return " or ".join(map(_name, _parts(type_)))
        case StructType() if type_.cls is Topic:
            return "the name of a topic"
        case StructType() if type_.fields:
            return f"keys such as `{type_.fields[0].encode_name}:`"
        case TupleType():
            return f"a list of {len(type_.item_types)} numbers"
    return NAMES.get(type(type_), "another value")


def explain(error: msgspec.ValidationError, hint: Any, values: Any) -> Fault:
    """Return the place of an invalid value, and what was expected.

    Args:
        error: of converting `values` to `hint`.
        hint: a type, such as a display's class.
        values: plain values, as in a config file.
    """
    return first_fault(hint, values) or Fault((), str(error))


def mistakes(
    cls: type[Declared],
    values: Mapping[str, Any],
    error: msgspec.ValidationError,
    others: Iterable[str] = (),
) -> list[Fault]:
    """All errors in the properties of a display or tool.

    Args:
        cls: of the display or tool.
        values: plain values, as in a config file.
        error: of making it; it names only the first mistake.
        others: keys that are valid without being properties.
    """
    fields = [*cls.__struct_fields__, *others]
    faults: list[Fault] = []
    for key, value in values.items():
        if key not in fields:
            faults.append(Fault((key,), unknown_key(key, fields)))
        elif key not in others:
            try:
                make(cls, {key: value})
            except msgspec.ValidationError as single:
                faults.append(explain(single, cls, {key: value}))
    return faults or [explain(error, cls, values)]  # the values may contradict each other


def sentences(mistakes: Sequence[tuple[Path, str]], place: Location = Location()) -> str:  # noqa: B008
    """Errors with their places, up to a limit."""
    texts = [place.at(*path).says(clause) for path, clause in mistakes[:MAX_MISTAKES]]
    if len(mistakes) > MAX_MISTAKES:
        texts.append(f"{len(mistakes) - MAX_MISTAKES} more errors.")
    return joined(*texts)
