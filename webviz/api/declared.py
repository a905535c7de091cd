"""Classes with declared properties: displays, tools and panels.

    size: Annotated[float, Prop(gt=0, unit="m", help="Edge of each point.")] = 0.03

One field declares the control in the panel, the key in config files, the validation, and the entry
in the docs and in .rviz files.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal, TypeVar

import msgspec

from webviz.data.names import readable

Byte = Annotated[int, msgspec.Meta(ge=0, le=255)]
Color = tuple[Byte, Byte, Byte]
"""Red, green and blue, 0 to 255."""
MAX_NESTED = 64
"""Parts of a path, as many as a config file has levels."""


class Topic(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A topic and how to subscribe to it. In a config file the bare name is enough."""

    name: str = ""
    reliability: Literal["auto", "reliable", "best_effort"] = "auto"
    durability: Literal["auto", "volatile", "transient_local"] = "auto"
    depth: Annotated[int, msgspec.Meta(ge=0)] = 0
    """0 chooses the depth by message type."""
    filter_size: Annotated[int, msgspec.Meta(ge=1)] = 10
    """Messages that may wait for their transform."""


def Prop(
    *,
    help: str = "",
    unit: str = "",
    rviz: str = "",
    rviz_default: object = None,
    rviz_factor: float = 1.0,
    when: tuple[str, object] | None = None,
    widget: Literal["", "displays", "frame", "names"] = "",
    otherwise: str = "",
    gt: float | None = None,
    ge: float | None = None,
    lt: float | None = None,
    le: float | None = None,
) -> msgspec.Meta:
    """Annotates a property.

    Args:
        help: one sentence, the tooltip of the control.
        unit: "m", "s", "px", ...
        rviz: RViz's name, if it differs from this name with spaces and capitals.
        rviz_default: RViz's default, if it differs: what a .rviz file without the property means.
        rviz_factor: RViz's number for what this one is 1 for, such as 2 for a radius that RViz
            draws as a diameter.
        when: (property, value) at which this property has an effect; several values as a tuple.
        widget: the control, if the type alone does not determine it; "frame" for the id of a frame,
            or for switches by the ids of frames; "names" for switches by names that the display
            offers, see `Context.offered`; "displays" for switches of the other displays.
        otherwise: of switches, the property that holds for names without one.
        gt, ge, lt, le: bounds.
    """
    hints = {"unit": unit, "rviz": rviz, "when": when, "widget": widget, "otherwise": otherwise}
    extra: dict[str, object] = {key: value for key, value in hints.items() if value}
    if rviz_default is not None:
        extra["rviz_default"] = rviz_default
    if rviz_factor != 1.0:
        extra["rviz_factor"] = rviz_factor
    bounds: dict[str, Any] = {"gt": gt, "ge": ge, "lt": lt, "le": le}
    return msgspec.Meta(description=help or None, extra=extra, **bounds)


class Declared(msgspec.Struct, kw_only=True, forbid_unknown_fields=True, eq=False, weakref=True):
    """Base of all classes with properties."""

    kind: ClassVar[str] = ""
    """The kind of plug-in: "display", "tool" or "panel"; names its entry point group."""
    title: ClassVar[str] = ""
    """The default name; "" is the name of the class."""
    rviz: ClassVar[str] = ""
    """The class of the counterpart in a .rviz file."""
    module: ClassVar[str] = ""
    """A JavaScript module for the page: a file beside that of the class; see `webviz.api.modules`.
    """

    name: Annotated[str, msgspec.Meta(description="Shown in lists.")] = ""


P = TypeVar("P", bound=Declared)


def default_name(cls: type[Declared]) -> str:
    """Return the name of an instance without one of its own."""
    return cls.title or cls.__name__


def make(cls: type[P], values: dict[str, Any]) -> P:
    """Return a display, tool or panel from plain values, as in a config file.

    A topic may be given by its name alone. Missing keys of a nested setting have their defaults.

    Raises:
        msgspec.ValidationError: a value is invalid; the text ends with its path.
    """
    declared = _by_default(cls) if not values else None
    if declared is None:
        declared = msgspec.convert(completed(cls, values), cls, strict=True)
    _check_finite(declared, "$")
    declared.name = readable(declared.name) or default_name(cls)
    return declared


def _by_default(cls: type[P]) -> P | None:
    """Return an instance without values, None if that fails: the conversion reports the cause.

    The first conversion to a class takes milliseconds, which add up at the start of a viewer.
    """
    try:
        return cls()
    except (TypeError, ValueError):
        return None


def completed(cls: type[Declared], values: Mapping[str, Any]) -> dict[str, Any]:
    """Plain values with topics as keys, and with the missing keys of nested settings."""
    defaults = _defaults(cls)
    return {key: _merge(defaults.get(key), value) for key, value in values.items()}


@functools.cache
def _defaults(cls: type[Declared]) -> dict[str, Any]:
    """Return the defaults of properties by name.

    `msgspec.structs.fields` knows them too, but evaluates all annotations.
    """
    fields, defaults = cls.__struct_fields__, cls.__struct_defaults__
    return dict(zip(fields[len(fields) - len(defaults) :], defaults, strict=True))


def set_property(declared: Declared, path: str, value: Any) -> None:
    """Set one property, nested ones by a dotted path (`topic.depth`).

    Raises:
        msgspec.ValidationError: the value is invalid; nothing was changed.
        AttributeError: the property does not exist.
    """
    if path.count(".") >= MAX_NESTED:
        raise AttributeError(f"{type(declared).__name__} has no property nested that deeply")
    head, _, rest = path.partition(".")
    if head not in declared.__struct_fields__:
        raise AttributeError(f"{type(declared).__name__} has no property {head!r}")
    whole = _replaced(getattr(declared, head), rest.split(".") if rest else [], value)
    checked = make(type(declared), {head: whole})
    setattr(declared, head, getattr(checked, head))


def _replaced(current: Any, path: list[str], value: Any) -> Any:
    """Return `current` as plain values, with the value at a path replaced."""
    plain = msgspec.to_builtins(current)
    if not path:
        return _merge(current, value)
    inner = plain if isinstance(plain, dict) else {}
    return {**inner, path[0]: _replaced(inner.get(path[0]), path[1:], value)}


def _merge(default: Any, value: Any) -> Any:
    """`value` as plain values, completed from `default`."""
    if isinstance(default, Topic) and isinstance(value, str):
        value = {"name": value}
    if isinstance(default, msgspec.Struct) and isinstance(value, dict):
        whole = {name: getattr(default, name) for name in default.__struct_fields__}
        return msgspec.to_builtins(
            {**whole, **{key: _merge(whole.get(key), item) for key, item in value.items()}}
        )
    if isinstance(value, msgspec.Struct):
        return msgspec.to_builtins(value)
    return value


def _check_finite(value: Any, path: str) -> None:
    """YAML has .inf and .nan, and bounds such as gt=0 accept infinity."""
    if isinstance(value, float) and not math.isfinite(value):
        raise msgspec.ValidationError(f"Expected a finite number, got {value} - at `{path}`")
    if isinstance(value, msgspec.Struct):
        for name in value.__struct_fields__:
            _check_finite(getattr(value, name), f"{path}.{name}")
    elif isinstance(value, tuple | list):
        for index, item in enumerate(value):
            _check_finite(item, f"{path}[{index}]")


def to_values(declared: Declared) -> dict[str, Any]:
    """Return the properties that differ from the defaults, as plain values for a config file."""
    defaults = msgspec.to_builtins(type(declared)(name=default_name(type(declared))))
    values = _difference(msgspec.to_builtins(declared), defaults)
    for name, value in values.items():
        if isinstance(getattr(declared, name), Topic) and set(value) == {"name"}:
            values[name] = value["name"]
    return values


def _difference(values: dict[str, Any], defaults: dict[str, Any]) -> dict[str, Any]:
    result = {}
    for key, value in values.items():
        default = defaults.get(key)
        if isinstance(value, dict) and isinstance(default, dict):
            if difference := _difference(value, default):
                result[key] = difference
        elif value != default:
            result[key] = value
    return result
