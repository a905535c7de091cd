"""Commands of pages, drawn by field: mostly with names and values that a viewer knows."""

from __future__ import annotations

import functools
from random import Random
from typing import Any

import msgspec.inspect as inspect

from webviz.api.panel import Panel
from webviz.api.properties import Property, properties_of
from webviz.api.registry import display_types, plugin_types
from webviz.api.tool import Tool
from webviz.page.dispatcher import form_of

FRAMES = ("map", "odom", "base_link", "laser", "no such frame", "")
VIEWS = ("Home", "a", "", "<b>", "\N{SNOWMAN}" * 50)
EXTREMES: dict[type[inspect.Type], tuple[Any, ...]] = {
    inspect.BoolType: (False, True),
    inspect.IntType: (0, 1, 5, 255, -1, 2**31, 2**53),
    inspect.FloatType: (0.0, 0.5, 1.0, 10.0, -1.0, 1e-300, 1e308),
    inspect.StrType: ("", "a", "map", "/topic", "x" * 40_000, "\x00", "../x", "<img src=x>"),
    inspect.AnyType: (None, True, 1, 0.5, "a", [], {}, [[1]]),
}


def arguments(random: Random, command: str) -> dict[str, Any]:
    """Fields of a command of pages, by its name."""
    if command in OWNERS:
        field, base = OWNERS[command]
        number, cls = random.choice(list(enumerate(_types(base).values(), start=1)))
        property_ = random.choice(_leaves(cls))
        id_ = f"display{number}" if field == "display" else cls().name or cls.title
        return {
            field: id_,
            "path": property_.path,
            "value": _of_type(random, property_.type, property_.path),
        }
    declared = inspect.type_info(form_of(command))
    assert isinstance(declared, inspect.StructType)
    return {
        each.encode_name: _of_type(random, each.type, each.encode_name, command)
        for each in declared.fields
        if each.required or random.random() < 0.5
    }


OWNERS = {
    "SetProperty": ("display", "displays"),
    "SetToolProperty": ("tool", "tools"),
    "SetPanelProperty": ("panel", "panels"),
}
"""Commands that set a property: the field that says of what, and of which kind it is."""


@functools.cache
def _types(kind: str) -> dict[str, type[Any]]:
    if kind == "displays":  # numbered as in the config of the attacked viewer
        return {name: cls for name, cls in display_types().items() if name != "Group"}
    return dict(plugin_types(Tool if kind == "tools" else Panel))


@functools.cache
def _leaves(cls: type[Any]) -> list[Property]:
    leaves, waiting = [], list(properties_of(cls))
    while waiting:
        each = waiting.pop()
        waiting += each.children
        if not each.children:
            leaves.append(each)
    return sorted(leaves, key=lambda each: each.path)


def _existing(random: Random, field: str, command: str) -> Any:
    """A name that the viewer may know, None if the field is none of names."""
    match field:
        case "display" | "displays" | "before":
            return f"display{random.randint(1, len(_types('displays')))}"
        case "group":
            return ""
        case "frame" | "target_frame" | "reference_frame" | "fixed_frame":
            return random.choice(FRAMES)
        case "type":
            return random.choice(sorted(_types("panels" if command == "AddPanel" else "displays")))
        case "panel":
            return "Navigation 2"
        case "key":
            return random.choice(("type", "distance", "pitch", "yaw", "target_frame", "scale"))
        case "name" | "new_name" if "View" in command:
            return random.choice(VIEWS)
        case "name" | "path":
            return random.choice(("a.yaml", "b.rviz", "attacked.yaml"))
        case "text":
            return "version: 1\ndisplays: [{type: Grid}]\n"
        case "steps":
            return random.randint(1, 3)
        case "hz":
            return random.choice((1.0, 30.0, 240.0))
        case _:
            return None


def _of_type(random: Random, type_: inspect.Type, field: str, command: str = "") -> Any:
    """A value that mostly fits a type."""
    while isinstance(type_, inspect.Metadata | inspect.CustomType):
        if isinstance(type_, inspect.CustomType):
            return None
        type_ = type_.type
    existing = _existing(random, field.rpartition(".")[2], command)
    simple = isinstance(type_, inspect.StrType | inspect.IntType | inspect.FloatType)
    if simple and existing is not None and random.random() < 0.9:
        return existing

    def inner(part: inspect.Type) -> Any:
        return _of_type(random, part, field, command)

    match type_:
        case inspect.LiteralType(values=values):
            return random.choice(values)
        case inspect.UnionType(types=types):
            return inner(random.choice(types))
        case inspect.TupleType(item_types=types):
            return [inner(each) for each in types]
        case inspect.VarTupleType(item_type=item) | inspect.ListType(item_type=item):
            return [inner(item) for _ in range(random.randrange(4))]
        case inspect.DictType():
            return {}
        case inspect.StructType() | inspect.DataclassType():
            fields = {
                each.encode_name: _of_type(random, each.type, each.encode_name, command)
                for each in type_.fields
                if each.required or random.random() < 0.3
            }
            if isinstance(type_, inspect.StructType) and type_.tag_field:
                fields[type_.tag_field] = type_.tag
            return fields
        case inspect.IntType() | inspect.FloatType() if random.random() < 0.7:
            return _within(random, type_)
        case _:
            return random.choice(EXTREMES.get(type(type_), (None,)))


def _within(random: Random, type_: inspect.IntType | inspect.FloatType) -> float:
    """A number within the bounds, at them as often as not."""
    low = next((each for each in (type_.ge, type_.gt) if each is not None), 0)
    high = next((each for each in (type_.le, type_.lt) if each is not None), low + 10)
    number = random.choice((low, high, random.uniform(low, high)))
    return round(number) if isinstance(type_, inspect.IntType) else float(number)
