"""The types of displays."""

from __future__ import annotations

import base64
import contextlib
import functools
from collections.abc import Mapping
from importlib import resources
from typing import Any

from webviz.api.display import Display, inputs_of
from webviz.api.ports import ANY
from webviz.api.registry import display_types
from webviz.engine.state import State


def types(state: State, _: str) -> Mapping[str, Any]:
    """Every display type by its name: a line of "help", the message types that it shows as
    "topics", and a "picture" as an address that holds it, "" without one."""
    return {name: _about(name, cls) for name, cls in sorted(display_types().items())}


@functools.cache
def _about(name: str, cls: type[Display]) -> Mapping[str, Any]:
    text = (cls.__doc__ or "").strip()
    shown = [type_ for spec in inputs_of(cls).values() if not spec.follows for type_ in spec.types]
    return {
        "help": " ".join(text.split("\n\n")[0].split()),
        "topics": ["any type" if type_ == ANY else type_ for type_ in dict.fromkeys(shown)],
        "picture": _picture(name, cls.__module__.partition(".")[0]),
    }


def _picture(name: str, package: str) -> str:
    """The picture of a type in the folder `pictures` of its package."""
    with contextlib.suppress(ImportError, TypeError, ValueError, OSError):  # of a single file
        data = (resources.files(package) / "pictures" / f"{name}.webp").read_bytes()
        return f"data:image/webp;base64,{base64.b64encode(data).decode()}"
    return ""
