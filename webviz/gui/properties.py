"""What a display class declares about its properties, read for the panel."""

from __future__ import annotations

import functools
import typing
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import msgspec
import msgspec.inspect

from webviz.display import Display, Input, inputs_of

FIRST = ("name", "enabled")


@dataclass(frozen=True)
class Property:
    """One property of a display.

    Args:
        path: dotted, from the display.
        label: RViz's name, with the unit.
        help: one sentence, or "".
        type: its type, bounds included.
        when: path and value of the property that decides whether this one has a meaning.
        widget: see `webviz.Prop`.
        input: what it subscribes to, if it is a topic.
        choices: the values it may have, in the order of declaration; () where it is no choice.
        children: the properties of a nested setting.
    """

    path: str
    label: str
    help: str
    type: msgspec.inspect.Type
    when: tuple[str, object] | None
    widget: str
    input: Input | None
    choices: tuple[Any, ...]
    children: tuple[Property, ...]

    def of(self, display: Display) -> Any:
        """Its value."""
        return value_at(display, self.path)

    def applies(self, display: Display) -> bool:
        """Whether it has a meaning as the other properties are."""
        return self.when is None or value_at(display, self.when[0]) == self.when[1]


def value_at(display: Display, path: str) -> Any:
    """The value at a dotted path."""
    value: Any = display
    for name in path.split("."):
        value = getattr(value, name)
    return value


@functools.cache
def properties_of(cls: type[Display]) -> tuple[Property, ...]:
    """The properties of a display class, the name first."""
    found = _properties(cls, "", inputs_of(cls))
    return tuple(sorted(found, key=lambda each: each.path not in FIRST))


def _properties(
    cls: type[msgspec.Struct], prefix: str, inputs: dict[str, Input]
) -> tuple[Property, ...]:
    info = msgspec.inspect.type_info(cls)
    assert isinstance(info, msgspec.inspect.StructType)
    hints = typing.get_type_hints(cls, include_extras=True)
    return tuple(
        _property(field, prefix, inputs.get(field.name), _choices(hints[field.name]))
        for field in info.fields
    )


def _choices(hint: Any) -> tuple[Any, ...]:
    """What a Literal allows; msgspec knows it too, but sorted."""
    while typing.get_origin(hint) is Annotated:
        hint = typing.get_args(hint)[0]
    return typing.get_args(hint) if typing.get_origin(hint) is Literal else ()


def _property(
    field: msgspec.inspect.Field, prefix: str, declared: Input | None, choices: tuple[Any, ...]
) -> Property:
    type_, known, help_ = field.type, {}, ""
    while isinstance(type_, msgspec.inspect.Metadata):
        help_ = help_ or (type_.extra_json_schema or {}).get("description", "")
        known = {**(type_.extra or {}), **known}
        type_ = type_.type
    path = prefix + field.name
    when = known.get("when")
    nested = type_.cls if isinstance(type_, msgspec.inspect.StructType) else None
    return Property(
        path=path,
        label=_label(field.name, known.get("rviz", ""), known.get("unit", "")),
        help=help_,
        type=type_,
        when=(prefix + when[0], when[1]) if when else None,
        widget=known.get("widget", ""),
        input=declared,
        choices=choices,
        children=_properties(nested, f"{path}.", {}) if nested else (),
    )


def _label(name: str, rviz: str, unit: str) -> str:
    label = rviz or name.replace("_", " ").title()
    return label if not unit or label.endswith(f"({unit})") else f"{label} ({unit})"
