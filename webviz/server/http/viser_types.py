"""viser's types of messages."""

from __future__ import annotations

from typing import Any

from viser import _messages as wire


def message_type(kind: str) -> type[Any]:
    """viser's dataclass of a kind of messages."""
    return getattr(wire, kind)
