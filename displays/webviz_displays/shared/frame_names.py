"""Frames as a user names them in a property."""

from __future__ import annotations

FIXED_FRAME = "<Fixed Frame>"
"""RViz's name for the current fixed frame."""


def frame_of(name: str) -> str | None:
    """Return the frame id of a property, None for the fixed frame."""
    return None if name in ("", FIXED_FRAME) else name.removeprefix("/")


def prefixed(prefix: str, link: str) -> str:
    """Return the frame id of a link of a robot whose frames have a prefix, as in prefix/link."""
    prefix = prefix.strip("/")
    return f"{prefix}/{link}" if prefix else link
