"""Where each property of a display or tool stands in RViz's tree of properties."""

from __future__ import annotations

import functools
import typing
from dataclasses import dataclass
from typing import Annotated, Any

import msgspec

from webviz.api.declared import Declared
from webviz.api.display import Input
from webviz.api.tool import Output
from webviz.files.rviz.tree import Path
from webviz.files.rviz.values import LEAST

COMMON = ("name", "enabled")
"""Properties of every display or tool; RViz keeps them apart from the others."""


@dataclass(frozen=True)
class RvizProperty:
    """A property on both sides.

    Args:
        name: here.
        path: in RViz.
        kind: its type, without annotations.
        default: here and in RViz, except for the names of topics.
        low: least number allowed.
        high: greatest number allowed.
        port: of a topic, whether it is subscribed to or published.
    """

    name: str
    path: Path
    kind: Any
    default: Any
    low: float | None = None
    high: float | None = None
    port: Input | Output | None = None


@functools.lru_cache(maxsize=256)
def properties(cls: type[msgspec.Struct]) -> tuple[RvizProperty, ...]:
    """The properties of a display or tool, or of a nested setting, besides the common ones."""
    hints = typing.get_type_hints(cls, include_extras=True)
    left_out = COMMON if issubclass(cls, Declared) else ()
    return tuple(
        _property(field, hints[field.name])
        for field in msgspec.structs.fields(cls)
        if field.name not in left_out
    )


def _property(field: msgspec.structs.FieldInfo, hint: Any) -> RvizProperty:
    marks = []
    while typing.get_origin(hint) is Annotated:
        hint, *more = typing.get_args(hint)
        marks += more
    metas = [mark for mark in marks if isinstance(mark, msgspec.Meta)]
    lows = [meta.ge for meta in metas if meta.ge is not None]
    lows += [meta.gt + LEAST for meta in metas if meta.gt is not None]
    highs = [meta.le for meta in metas if meta.le is not None]
    highs += [meta.lt - LEAST for meta in metas if meta.lt is not None]
    rviz = "".join((meta.extra or {}).get("rviz", "") for meta in metas)
    default = field.default
    if default is msgspec.NODEFAULT and field.default_factory is not msgspec.NODEFAULT:
        default = field.default_factory()
    return RvizProperty(
        field.name,
        tuple(rviz.split("/")) if rviz else (_rviz_name(field.name),),
        hint,
        default,
        max(lows, default=None),
        min(highs, default=None),
        next((mark for mark in marks if isinstance(mark, Input | Output)), None),
    )


def _rviz_name(name: str) -> str:
    """RViz's usual name; an entry's switch is its own value there."""
    if name in ("value", "enabled"):
        return "Value"
    return " ".join(word.capitalize() for word in name.split("_"))
