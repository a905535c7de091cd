"""What a class declares about its properties: the one place that reads declarations."""

from __future__ import annotations

import functools
import typing
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import msgspec
import msgspec.inspect

from webviz.api.display import Input

FIRST = ("name", "enabled")


@dataclass(frozen=True)
class Property:
    """One property of a display, tool or panel.

    Args:
        path: dotted, from the whole.
        label: RViz's name, with the unit.
        help: one sentence, or "".
        type: its type, bounds included.
        when: paths and values of the properties that decide whether this one has a meaning.
        widget: see `webviz.Prop`.
        input: what it subscribes to, if it is a topic.
        choices: the values it may have, in the order of declaration; () where it is no choice.
        children: the properties of a nested setting.
    """

    path: str
    label: str
    help: str
    type: msgspec.inspect.Type
    when: tuple[tuple[str, tuple[object, ...]], ...]
    widget: str
    input: Input | None
    choices: tuple[Any, ...]
    children: tuple[Property, ...]

    def of(self, declared: msgspec.Struct) -> Any:
        """Its value."""
        return value_at(declared, self.path)

    def applies(self, declared: msgspec.Struct) -> bool:
        """Whether it has a meaning as the other properties are."""
        return all(value_at(declared, path) in values for path, values in self.when)


def value_at(declared: msgspec.Struct, path: str) -> Any:
    """The value at a dotted path."""
    value: Any = declared
    for name in path.split("."):
        value = getattr(value, name)
    return value


@functools.cache
def properties_of(cls: type[msgspec.Struct]) -> tuple[Property, ...]:
    """The properties of a class, such as a display or tool; the name first."""
    found = _properties(cls, "", "")
    return tuple(sorted(found, key=lambda each: each.path not in FIRST))


def _properties(cls: type[msgspec.Struct], prefix: str, group: str) -> tuple[Property, ...]:
    info = msgspec.inspect.type_info(cls)
    assert isinstance(info, msgspec.inspect.StructType)
    hints = typing.get_type_hints(cls, include_extras=True)
    declared = {field.name: _declaration(field.type) for field in info.fields}
    found = []
    for name, (type_, known) in declared.items():
        # In RViz a group of properties may have a value of its own.
        own = group if name == "value" else name.replace("_", " ").title()
        label = _with_unit(known.get("rviz") or own, known.get("unit", ""))
        nested = type_.cls if isinstance(type_, msgspec.inspect.StructType) else None
        found.append(
            Property(
                path=prefix + name,
                label=label,
                help=known.get("description", ""),
                type=type_,
                when=_conditions(name, prefix, declared, hints),
                widget=known.get("widget", ""),
                input=_input(hints[name]),
                choices=_choices(hints[name]),
                children=_properties(nested, f"{prefix}{name}.", label) if nested else (),
            )
        )
    return tuple(found)


def _declaration(type_: msgspec.inspect.Type) -> tuple[msgspec.inspect.Type, dict[str, Any]]:
    """The bare type of a field, and what `webviz.Prop` says of it."""
    known: dict[str, Any] = {}
    while isinstance(type_, msgspec.inspect.Metadata):
        known = {**(type_.extra_json_schema or {}), **(type_.extra or {}), **known}
        type_ = type_.type
    return type_, known


def _conditions(
    name: str,
    prefix: str,
    declared: dict[str, tuple[Any, dict[str, Any]]],
    hints: dict[str, Any],
) -> tuple[tuple[str, tuple[object, ...]], ...]:
    """What must hold for a property: its own condition, and those of the property it names."""
    when = declared[name][1].get("when")
    if when is None:
        return ()
    other, wanted = when
    values = wanted if isinstance(wanted, tuple) else (wanted,)
    # A base class may name values that only some of its displays offer.
    choices = _choices(hints[other]) or values
    condition = prefix + other, tuple(value for value in values if value in choices)
    return (condition, *_conditions(other, prefix, declared, hints))


def _input(hint: Any) -> Input | None:
    marks = getattr(hint, "__metadata__", ())
    return next((mark for mark in marks if isinstance(mark, Input)), None)


def _choices(hint: Any) -> tuple[Any, ...]:
    """What a Literal allows; msgspec knows it too, but sorted."""
    while typing.get_origin(hint) is Annotated:
        hint = typing.get_args(hint)[0]
    return typing.get_args(hint) if typing.get_origin(hint) is Literal else ()


def _with_unit(label: str, unit: str) -> str:
    return label if not unit or label.endswith(f"({unit})") else f"{label} ({unit})"
