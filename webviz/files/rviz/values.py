"""Conversion of single RViz values."""

from __future__ import annotations

import math
import typing
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from PIL import ImageColor

LEAST = 1e-4
"""Replaces 0 where a size must be positive (RViz's own minimum for points)."""

AUTO = "Auto"
"""The label of an empty value in RViz: a choice made by the first message."""

_YES = ("true", "yes", "on", "1")
_NO = ("false", "no", "off", "0")
_FLOAT_MAX = float(np.finfo(np.float32).max)
_LONGEST = 1000
"""Maximum length of a name or a number."""


class Unfit(ValueError):
    """An invalid value; the text says why."""


def own_value(raw: Any) -> Any:
    """Return the value of a property that may have children; None if it has none of its own."""
    return raw.get("Value") if isinstance(raw, Mapping) else raw


def read(raw: Any, kind: Any) -> Any:
    """Return a value converted to `kind` (bool, int, float, str, a Literal or a tuple of numbers).

    Raises:
        Unfit: it is invalid; the text says why.
    """
    if typing.get_origin(kind) is tuple:
        parts = typing.get_args(kind)
        return _color(raw) if _is_color(parts) else _vector(raw, len(parts))
    raw = own_value(raw)
    if isinstance(raw, Mapping | list) or raw is None:
        raise Unfit("it has no value")
    if kind is bool:
        return _bool(raw)
    if kind is int:
        number = _number(raw)
        if number != int(number):
            raise Unfit(f"expected a whole number, got {raw}")
        return int(number)
    if kind is float:
        return _number(raw)
    if typing.get_origin(kind) is Literal:
        labels = typing.get_args(kind)
        if text(raw) not in labels:
            raise Unfit(f"expected {', '.join(map(str, labels))}, got `{text(raw)[:80]}`")
        return text(raw)
    if kind is str:
        return text(raw)
    raise Unfit("unsupported in RViz")


def write(value: Any, kind: Any) -> Any:
    """Return a value as RViz spells it."""
    if typing.get_origin(kind) is tuple:
        if _is_color(typing.get_args(kind)):
            return "; ".join(str(part) for part in value)
        return {axis: _plain(part) for axis, part in zip("XYZW", value, strict=False)}
    if typing.get_origin(kind) is Literal:
        return "" if value == AUTO else value
    return _plain(value)


def text(raw: Any) -> str:
    """Return a scalar as RViz reads it."""
    return str(raw).lower() if isinstance(raw, bool) else str(raw)


def human(number: float) -> float:
    """Return a number printed from single precision, in its shortest form: 0.03."""
    if abs(number) <= _FLOAT_MAX and float(np.float32(number)) == number:
        return float(str(np.float32(number)))
    return number


def _plain(value: Any) -> Any:
    is_whole = isinstance(value, float) and value.is_integer() and abs(value) < 1e15
    return int(value) if is_whole else value


def _is_color(parts: tuple[Any, ...]) -> bool:
    return all(typing.get_origin(part) is typing.Annotated for part in parts)


def _bool(raw: Any) -> bool:
    word = text(raw).strip().lower()
    if word in _YES or word in _NO:
        return word in _YES
    raise Unfit(f"expected true or false, got `{word[:80]}`")


def _number(raw: Any) -> float:
    try:
        number = float(text(raw)[:_LONGEST])
    except ValueError:
        raise Unfit(f"expected a number, got `{text(raw)[:80]}`") from None
    if not math.isfinite(number):
        raise Unfit(f"{number} is not finite")
    return human(number)


def _vector(raw: Any, length: int) -> tuple[float, ...]:
    if not isinstance(raw, Mapping):
        raise Unfit(f"it needs {', '.join('XYZW'[:length])}")
    return tuple(_number(own_value(raw.get(axis))) for axis in "XYZW"[:length])


def _color(raw: Any) -> tuple[int, ...]:
    """Return a colour such as "255; 0; 0", "#ff0000" or "red"."""
    words = text(own_value(raw))
    parts = words.split(";")
    if len(parts) == 3:
        return tuple(min(max(round(_number(part)), 0), 255) for part in parts)
    try:
        return tuple(ImageColor.getrgb(words.strip())[:3])
    except ValueError:
        raise Unfit(f"expected a colour, got `{words[:80]}`") from None
