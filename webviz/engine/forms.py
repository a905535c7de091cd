"""Properties for the page: what it needs to know to build their controls, and their values."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal

import msgspec
import msgspec.inspect as inspect

from webviz.api.ports import Input, Output
from webviz.api.properties import Property, properties_of

MAX_TEXT = 100_000
"""Characters of a value that is shown."""
OFFERED = ("names", "displays")
"""Widgets of switches whose names are not those of frames."""


PropertyKind = Literal[
    "bool",
    "choice",
    "color",
    "dict",
    "float",
    "frame",
    "group",
    "int",
    "list",
    "switches",
    "text",
    "topic",
    "vector",
]


class DeclaredProperty(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """A property, as the page needs it to build its control.

    Args:
        path: dotted.
        label: without the unit.
        kind: of the control.
        children: of a group.
        default: its value, unset for a group.
        help: a sentence.
        unit: of the value.
        choices: the values to choose from.
        when: paths and values of the properties that decide whether this one applies.
        type: message types of a topic, as `topics_of` reads them.
        items: kind of the items of a list.
        otherwise: path that holds the value of the switches that are not there.
        offered: whether the names of switches are offered, instead of being those of frames.
        low, high: bounds.
        above, below: bounds that are excluded.
    """

    path: str
    label: str
    kind: PropertyKind
    children: list[DeclaredProperty] | msgspec.UnsetType = msgspec.UNSET
    default: Any = msgspec.UNSET
    help: str = ""
    unit: str = ""
    choices: Sequence[Any] = ()
    when: Sequence[tuple[str, Sequence[Any]]] = ()
    type: str = ""
    items: Literal["text", "json", ""] = ""
    otherwise: str = ""
    offered: bool
    low: float | None = None
    above: float | None = None
    high: float | None = None
    below: float | None = None


Form = Annotated[msgspec.Raw, msgspec.Meta(extra={"of": list[DeclaredProperty]})]
"""The properties of a class, as JSON since they never change."""


@functools.lru_cache(maxsize=128)
def form(cls: type[msgspec.Struct], without: tuple[str, ...] = ()) -> msgspec.Raw:
    """Return the declared properties of a class, see `Form`; groups have theirs in "children"."""
    defaults = cls()
    declared = [
        _declared(each, defaults) for each in properties_of(cls) if each.path not in without
    ]
    return msgspec.Raw(msgspec.json.encode(declared))


def values_of(declared: msgspec.Struct, without: tuple[str, ...] = ()) -> dict[str, Any]:
    """All values by the path of their property."""
    properties = (each for each in properties_of(type(declared)) if each.path not in without)
    return {leaf.path: sendable(leaf.of(declared)) for leaf in leaves(properties)}


def leaves(properties: Iterator[Property] | tuple[Property, ...]) -> Iterator[Property]:
    """Yield the properties that have a value of their own."""
    for each in properties:
        if each.children:
            yield from leaves(each.children)
        else:
            yield each


def brief(text: str, most: int = 300) -> str:
    """Return a text that JSON can hold, of so many characters at most."""
    return sendable(text if len(text) <= most else f"{text[: most - 1]}…")


def sendable(value: Any) -> Any:
    """Return a value that JSON can hold: without halves of letters, and no endless texts."""
    if isinstance(value, str):
        short = value if len(value) <= MAX_TEXT else value[: MAX_TEXT - 1] + "…"
        return short.encode(errors="replace").decode()
    if isinstance(value, Mapping):
        return {str(sendable(str(key))): sendable(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [sendable(item) for item in value]
    return sendable(msgspec.to_builtins(value)) if isinstance(value, msgspec.Struct) else value


def _declared(each: Property, defaults: msgspec.Struct) -> DeclaredProperty:
    label = each.label.removesuffix(f" ({each.unit})").rpartition("/")[2]
    children = [_declared(child, defaults) for child in each.children]
    return DeclaredProperty(
        path=each.path,
        label=label,
        kind=_kind(each),
        children=children or msgspec.UNSET,
        default=msgspec.UNSET if children else sendable(each.of(defaults)),
        help=each.help,
        unit=each.unit,
        choices=each.choices,
        when=each.when,
        type=_message_types(each.port),
        items=_items(each.type),
        otherwise=each.otherwise,
        offered=each.widget in OFFERED,
        **_bounds(each.type),
    )


def _message_types(port: Input | Output | None) -> str:
    """Return the message types of a topic, as `topics_of` reads them."""
    return ",".join(port.types) if isinstance(port, Input) else port.type if port else ""


def _kind(each: Property) -> PropertyKind:
    if each.port:
        return "topic"
    if each.children:
        return "group"
    if each.widget == "frame":
        return "switches" if isinstance(each.type, inspect.DictType) else "frame"
    if each.widget in OFFERED:
        return "switches"
    if each.choices:
        return "choice"
    match _value_type(each.type):
        case inspect.BoolType():
            return "bool"
        case inspect.IntType():
            return "int"
        case inspect.FloatType():
            return "float"
        case inspect.StrType():
            return "text"
        case inspect.DictType():
            return "dict"
        case inspect.TupleType(item_types=items) if len(items) in (2, 3):
            if all(isinstance(item, inspect.FloatType) or _is_float(item) for item in items):
                return "vector"
            if len(items) == 3 and all(
                isinstance(i, inspect.IntType) and i.le == 255 for i in items
            ):
                return "color"
    return "list"


def _value_type(type_: inspect.Type) -> inspect.Type:
    """Return the type of an optional value that is not None."""
    if isinstance(type_, inspect.UnionType):
        types = [one for one in type_.types if not isinstance(one, inspect.NoneType)]
        return types[0] if len(types) == 1 else type_
    return type_


def _is_float(item: inspect.Type) -> bool:
    """Return whether it is a number with more to say about it."""
    return isinstance(item, inspect.Metadata) and isinstance(item.type, inspect.FloatType)


def _items(type_: inspect.Type) -> Literal["text", "json", ""]:
    """Return the kind of items of a list or a dictionary: "text", or "json" for all else."""
    items = getattr(type_, "value_type", None) or getattr(type_, "item_type", None)
    if items is None and not isinstance(type_, inspect.TupleType):
        return ""
    return "text" if isinstance(items, inspect.StrType) else "json"


def _bounds(type_: inspect.Type) -> dict[str, Any]:
    if not isinstance(type_, inspect.IntType | inspect.FloatType):
        return {}
    bounds = {"low": type_.ge, "above": type_.gt, "high": type_.le, "below": type_.lt}
    return {key: bound for key, bound in bounds.items() if bound is not None}
