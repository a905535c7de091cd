"""The types of displays."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

from webviz.api.display import Display, inputs_of
from webviz.api.registry import display_types
from webviz.engine.state import State


def types(state: State, _: str) -> Mapping[str, Any]:
    """Every display type by its name: a line of help, and the message types that it shows."""
    return {name: _about(cls) for name, cls in sorted(display_types().items())}


@functools.cache
def _about(cls: type[Display]) -> Mapping[str, Any]:
    text = (cls.__doc__ or "").strip()
    shown = [spec.type for spec in inputs_of(cls).values() if not spec.suffix]
    return {"help": " ".join(text.split("\n\n")[0].split()), "topics": list(dict.fromkeys(shown))}
