"""Properties that several displays have alike: their types, their values and their remedies."""

from __future__ import annotations

from typing import Annotated

from webviz import Prop, Remedy

HistoryLength = Annotated[
    int, Prop(ge=1, le=10_000, help="How many of the newest messages to show.")
]
"""A property; the framework holds no more."""
FIXED_FRAME = "<Fixed Frame>"
"""RViz's name for the current fixed frame."""


def opaque(path: str = "alpha") -> Remedy:
    """Make it visible again.

    Args:
        path: of the property with the opacity.
    """
    return Remedy(path, 1.0, "Set alpha to 1")


def frame_of(name: str) -> str | None:
    """Return the frame id of a property, None for the fixed frame."""
    return None if name in ("", FIXED_FRAME) else name.removeprefix("/")


def prefixed(prefix: str, link: str) -> str:
    """Return the frame id of a link of a robot whose frames have a prefix, as in prefix/link."""
    prefix = prefix.strip("/")
    return f"{prefix}/{link}" if prefix else link
