"""The types of displays."""

from __future__ import annotations

import base64
import contextlib
import functools
from collections.abc import Mapping, Sequence
from importlib import resources
from typing import ClassVar

import msgspec

from webviz.api.display import Display, inputs_of
from webviz.api.ports import ANY
from webviz.api.registry import display_types
from webviz.engine.store import PageStore


class DisplayType(msgspec.Struct, frozen=True):
    """A type of displays.

    Args:
        help: a line.
        topics: the message types that it shows.
        icon: see `webviz.Display.icon`.
        picture: an address that holds it, "" without one.
    """

    help: str
    topics: Sequence[str]
    icon: str
    picture: str


class TypesStore(PageStore, frozen=True):
    """The types of displays by name."""

    spread: ClassVar = {"types": ""}

    types: Mapping[str, DisplayType]


def types_store() -> TypesStore:
    """Return every type of displays, sorted by name."""
    return TypesStore({name: _about(name, cls) for name, cls in sorted(display_types().items())})


@functools.cache
def _about(name: str, cls: type[Display]) -> DisplayType:
    text = (cls.__doc__ or "").strip()
    shown = [type_ for spec in inputs_of(cls).values() if not spec.follows for type_ in spec.types]
    return DisplayType(
        help=" ".join(text.split("\n\n")[0].split()),
        topics=["any type" if type_ == ANY else type_ for type_ in dict.fromkeys(shown)],
        icon=cls.icon,
        picture=_picture(name, cls.__module__.partition(".")[0]),
    )


def _picture(name: str, package: str) -> str:
    """Return the picture of a type in the folder `pictures` of its package."""
    with contextlib.suppress(ImportError, TypeError, ValueError, OSError):  # of a single file
        data = (resources.files(package) / "pictures" / f"{name}.webp").read_bytes()
        return f"data:image/webp;base64,{base64.b64encode(data).decode()}"
    return ""
