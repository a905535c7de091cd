"""The declared properties of a class: the only place that reads annotations."""

from __future__ import annotations

import functools
import inspect
import sys
import types
import typing
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import msgspec
import msgspec.inspect

from webviz.api.ports import Input, Output

FIRST = ("name", "enabled")


@dataclass(frozen=True)
class Property:
    """One property of a display, tool, panel, view or nested setting.

    Args:
        path: dotted, from the whole.
        label: RViz's name, with the unit.
        help: one sentence, or "".
        unit: "m", "s", "px", ... or "".
        rviz, rviz_default, rviz_factor: see `webviz.Prop`.
        widget: see `webviz.Prop`.
        otherwise: path of the property that holds for names without a value here, or "".
        hint: its Python type without annotations.
        type: the same as msgspec describes it, bounds included.
        default: not to be changed; `msgspec.NODEFAULT` if it is required.
        port: what it subscribes to or publishes, if it is a topic.
        when: paths and values of the properties that decide whether this one applies.
        choices: the values of a `Literal` in the order of declaration, else ().
        children: the properties of a nested setting.
    """

    path: str
    label: str
    help: str
    unit: str
    rviz: str
    rviz_default: object
    rviz_factor: float
    widget: str
    otherwise: str
    hint: Any
    type: msgspec.inspect.Type
    default: Any
    port: Input | Output | None
    when: tuple[tuple[str, tuple[object, ...]], ...]
    choices: tuple[Any, ...]
    children: tuple[Property, ...]

    def of(self, declared: msgspec.Struct) -> Any:
        """Its value."""
        return value_at(declared, self.path)

    def applies(self, declared: msgspec.Struct) -> bool:
        """Return whether the other properties let it have an effect."""
        return all(value_at(declared, path) in values for path, values in self.when)


def value_at(declared: msgspec.Struct, path: str) -> Any:
    """Return the value at a dotted path."""
    value: Any = declared
    for name in path.split("."):
        value = getattr(value, name)
    return value


@functools.cache
def properties_of(cls: type[msgspec.Struct]) -> tuple[Property, ...]:
    """Return the properties of a class, such as a display or tool; the name first."""
    properties = _properties(cls, "", "")
    return tuple(sorted(properties, key=lambda each: each.path not in FIRST))


def ports_of(cls: type[msgspec.Struct]) -> dict[str, Input | Output]:
    """Return the inputs and outputs of a class by property, in the order of declaration.

    A viewer needs those of all displays to start, and to describe all their types takes longer.
    """
    facts = {name: _facts(hint) for name, hint in _hints(cls).items()}
    return {name: by_field["port"] for name, by_field in facts.items() if "port" in by_field}


def _hints(cls: type[msgspec.Struct]) -> dict[str, Any]:
    """Return the types of a class's fields with their annotations."""
    hints: dict[str, Any] = {}
    for base in reversed(cls.__mro__):
        hints |= _own_hints(base)
    return {name: hints[name] for name in cls.__struct_fields__}


@functools.cache
def _own_hints(cls: type) -> dict[str, Any]:
    """Return those of the fields that a class adds.

    `typing.get_type_hints` evaluates those of a base class again for each class derived from it.
    """
    names = getattr(cls, "__struct_fields__", ())
    own = {name: hint for name, hint in inspect.get_annotations(cls).items() if name in names}
    module = vars(sys.modules[cls.__module__])
    like = types.SimpleNamespace(__annotations__=own)
    return typing.get_type_hints(like, module, dict(vars(cls)), include_extras=True)


def bare(hint: Any) -> Any:
    """Return a type without its annotations."""
    while typing.get_origin(hint) is Annotated:
        hint = typing.get_args(hint)[0]
    return hint


def _properties(cls: type[msgspec.Struct], prefix: str, group: str) -> tuple[Property, ...]:
    info = msgspec.inspect.type_info(cls)
    assert isinstance(info, msgspec.inspect.StructType)
    hints = _hints(cls)
    facts = {field.name: _facts(hints[field.name]) for field in info.fields}
    properties = []
    for field in info.fields:
        name, hint, fact = field.name, hints[field.name], facts[field.name]
        # In RViz a group of properties may have a value of its own.
        own = group if name == "value" else name.replace("_", " ").title()
        label = _with_unit(fact.get("rviz") or own, fact.get("unit", ""))
        type_ = field.type
        while isinstance(type_, msgspec.inspect.Metadata):
            type_ = type_.type
        nested = type_.cls if isinstance(type_, msgspec.inspect.StructType) else None
        properties.append(
            Property(
                path=prefix + name,
                label=label,
                help=fact.get("help", ""),
                unit=fact.get("unit", ""),
                rviz=fact.get("rviz", ""),
                rviz_default=fact.get("rviz_default"),
                rviz_factor=fact.get("rviz_factor", 1.0),
                widget=fact.get("widget", ""),
                otherwise=prefix + other if (other := fact.get("otherwise")) else "",
                hint=bare(hint),
                type=type_,
                default=_default(field),
                port=fact.get("port"),
                when=_conditions(name, prefix, facts, hints),
                choices=_choices(hint),
                children=_properties(nested, f"{prefix}{name}.", label) if nested else (),
            )
        )
    return tuple(properties)


def _facts(hint: Any) -> dict[str, Any]:
    """Return the values of a type's annotations; the outermost wins."""
    facts: dict[str, Any] = {}
    for mark in getattr(hint, "__metadata__", ()):
        if isinstance(mark, Input | Output):
            facts["port"] = mark
        elif isinstance(mark, msgspec.Meta):
            facts |= mark.extra or {}
            facts |= {"help": mark.description} if mark.description else {}
    return facts


def _default(field: msgspec.inspect.Field) -> Any:
    if field.default_factory is not msgspec.NODEFAULT:
        return field.default_factory()
    return field.default


def _conditions(
    name: str, prefix: str, known: Mapping[str, Mapping[str, Any]], hints: Mapping[str, Any]
) -> tuple[tuple[str, tuple[object, ...]], ...]:
    """Return the conditions of a property: its own, and those of the property it names."""
    when = known[name].get("when")
    if when is None:
        return ()
    other, expected = when
    values = expected if isinstance(expected, tuple) else (expected,)
    # A base class may name values that only some of its displays offer.
    choices = _choices(hints[other]) or values
    condition = prefix + other, tuple(value for value in values if value in choices)
    return (condition, *_conditions(other, prefix, known, hints))


def _choices(hint: Any) -> tuple[Any, ...]:
    """Return the values of a Literal; msgspec has them too, but sorted."""
    hint = bare(hint)
    return typing.get_args(hint) if typing.get_origin(hint) is Literal else ()


def _with_unit(label: str, unit: str) -> str:
    return label if not unit or label.endswith(f"({unit})") else f"{label} ({unit})"
