"""Which widget suits which type of property."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import msgspec
import msgspec.inspect as inspect
import viser

from webviz.api.panel import Edit
from webviz.api.properties import Property
from webviz.edges.gui.control import TYPING_S, Choice, Control
from webviz.edges.gui.text import plain

MAX_TEXT = 100_000

_DIGITS = 6  # decimals that a number field shows and takes


def add_control(gui: viser.GuiApi, declared: Property, value: Any, edit: Edit) -> Control:
    """Add the widget for one property, nested settings and topics excepted.

    Args:
        gui: viser's GUI; the widget goes into the folder that is open.
        declared: the property.
        value: what it has now.
        edit: called with a new value of the property's type, and the id of the browser.
    """
    label, hint, type_ = declared.label, declared.help or None, declared.type
    if declared.widget == "frame":
        return Choice(gui, label, value, edit, hint, free=True)
    if declared.choices:
        return _add_choice(gui, declared, value, edit)
    if isinstance(type_, inspect.BoolType):
        return Control(gui.add_checkbox(label, bool(value), hint=hint), edit)
    if isinstance(type_, inspect.IntType | inspect.FloatType):
        return _add_number(gui, declared, type_, value, edit)
    if isinstance(type_, inspect.StrType):
        return Control(gui.add_text(label, _line(value), hint=hint), edit, _line, wait=TYPING_S)
    if _is_color(type_):
        return Control(gui.add_rgb(label, value, hint=hint), edit, tuple)
    if _numbers(type_) == 2:
        return Control(gui.add_vector2(label, value, step=0.1, hint=hint), edit, _floats)
    if _numbers(type_) == 3:
        return Control(gui.add_vector3(label, value, step=0.1, hint=hint), edit, _floats)
    return _add_lines(gui, declared, value, edit)


def _add_choice(gui: viser.GuiApi, declared: Property, value: Any, edit: Edit) -> Control:
    values = {str(choice): choice for choice in declared.choices}
    widget = gui.add_dropdown(
        declared.label, tuple(values), initial_value=str(value), hint=declared.help or None
    )
    return Control(widget, edit, str, values.__getitem__)


def _add_number(
    gui: viser.GuiApi,
    declared: Property,
    type_: inspect.IntType | inspect.FloatType,
    value: float,
    edit: Edit,
) -> Control:
    kind = int if isinstance(type_, inspect.IntType) else float
    low = _first(type_.ge, type_.gt)
    high = _first(type_.le, type_.lt)
    hint = declared.help or None
    if low is not None and high is not None and low <= value <= high:
        step = kind(1) if kind is int else _power_of_ten((high - low) / 100)
        widget: Any = gui.add_slider(
            declared.label, kind(low), kind(high), step, kind(value), hint=hint
        )
    else:
        widget = gui.add_number(
            declared.label,
            kind(value),
            min=low if low is None or low <= value else None,
            max=high if high is None or high >= value else None,
            step=1 if kind is int else _power_of_ten(abs(value) / 10 or 0.1),
            hint=hint,
        )
    if kind is float:
        widget.precision = _DIGITS
    return Control(widget, edit, kind)


def _add_lines(gui: viser.GuiApi, declared: Property, value: Any, edit: Edit) -> Control:
    """Lists, mappings and tuples: an entry per line, texts as they are, all else as JSON."""
    type_ = declared.type
    items = getattr(type_, "value_type", None) or getattr(type_, "item_type", None)
    dump, load = (_line, str) if isinstance(items, inspect.StrType) else (_dump, _load)

    def encode(value: Any) -> str:
        if isinstance(value, Mapping):
            return "\n".join(f"{_line(key)}: {dump(item)}" for key, item in value.items())
        return "\n".join(map(dump, value))

    def decode(text: str) -> Any:
        lines = [line.strip() for line in text.splitlines() if line.strip()]
        if not isinstance(type_, inspect.DictType):
            return [load(line) for line in lines]
        entries = [line.partition(": ") for line in lines]
        return {key.strip(): load(item.strip()) for key, _, item in entries}

    widget = gui.add_text(declared.label, encode(value), multiline=True, hint=declared.help or None)
    return Control(widget, edit, encode, decode, wait=TYPING_S)


def _dump(item: Any) -> str:
    return msgspec.json.encode(item).decode()


def _load(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        raise ValueError(f'{text!r} is not valid; enter true, 0.5 or "text".') from None


def _line(text: str) -> str:
    return plain(text, MAX_TEXT)


def _first(*bounds: float | None) -> float | None:
    return next((bound for bound in bounds if bound is not None), None)


def _power_of_ten(size: float) -> float:
    """The largest power of ten up to `size`."""
    return 10.0 ** math.floor(math.log10(size))


def _is_color(type_: inspect.Type) -> bool:
    return (
        isinstance(type_, inspect.TupleType)
        and len(type_.item_types) == 3
        and all(isinstance(item, inspect.IntType) and item.le == 255 for item in type_.item_types)
    )


def _numbers(type_: inspect.Type) -> int:
    """How many numbers a tuple of numbers has, 0 for anything else."""
    if isinstance(type_, inspect.TupleType) and all(
        isinstance(item, inspect.FloatType) for item in type_.item_types
    ):
        return len(type_.item_types)
    return 0


def _floats(values: Any) -> tuple[float, ...]:
    return tuple(float(value) for value in values)
