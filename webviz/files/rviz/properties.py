"""Place of each property of a display or tool in RViz's tree of properties."""

from __future__ import annotations

import functools
from typing import Any

import msgspec

from webviz.api.declared import Declared
from webviz.api.ports import Input, Output
from webviz.api.properties import Property, properties_of
from webviz.files.rviz.tree import Path
from webviz.files.rviz.values import LEAST

COMMON = ("name", "enabled")
"""Properties of every display or tool; RViz keeps them apart from the others."""


class RvizProperty(msgspec.Struct, frozen=True):
    """A property on both sides.

    Args:
        name: here.
        path: in RViz.
        kind: its type, without annotations.
        default: here.
        missing: what a file without it means, if that is not the default; None if it is. A topic
            without a name is none, see `topics.read`.
        low: least number allowed.
        high: greatest number allowed.
        port: of a topic, whether it is subscribed to or published.
        factor: number in RViz for what is 1 here.
        is_tree: whether it has a switch for each display, nested as displays are in groups.
    """

    name: str
    path: Path
    kind: Any
    default: Any
    missing: object = None
    low: float | None = None
    high: float | None = None
    port: Input | Output | None = None
    factor: float = 1.0
    is_tree: bool = False


@functools.lru_cache(maxsize=256)
def properties(cls: type[msgspec.Struct]) -> tuple[RvizProperty, ...]:
    """Return the properties of a display, tool or nested setting besides the common ones."""
    left_out = COMMON if issubclass(cls, Declared) else ()
    return tuple(_property(each) for each in properties_of(cls) if each.path not in left_out)


@functools.lru_cache(maxsize=256)
def keys(cls: type[Declared]) -> frozenset[str]:
    """Return the keys of a display or tool at the top level of its tree in RViz."""
    return frozenset(each.path[0] for each in properties(cls))


def _property(declared: Property) -> RvizProperty:
    missing = declared.rviz_default
    if declared.rviz_factor != 1.0:  # its default is RViz's number
        missing = declared.default / declared.rviz_factor
    ge, gt, le, lt = (getattr(declared.type, bound, None) for bound in ("ge", "gt", "le", "lt"))
    return RvizProperty(
        declared.path,
        tuple(declared.rviz.split("/")) if declared.rviz else (_rviz_name(declared.path),),
        declared.hint,
        declared.default,
        missing,
        ge if gt is None else gt + LEAST,
        le if lt is None else lt - LEAST,
        declared.port,
        declared.rviz_factor,
        declared.widget == "displays",
    )


def _rviz_name(name: str) -> str:
    """RViz's usual name; an entry's switch is its own value there."""
    if name in ("value", "enabled"):
        return "Value"
    return " ".join(word.capitalize() for word in name.split("_"))
