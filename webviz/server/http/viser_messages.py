"""Validation of the messages of browsers: kinds, sizes and fields."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

import msgspec
from viser import _messages as wire

from webviz.api.roles import Role
from webviz.server.access import rules


def message_type(kind: str) -> type[Any]:
    """viser's dataclass of a kind of messages."""
    return getattr(wire, kind)


MAX_BYTES = 4 << 20
"""Maximum size of a message; the longest is a config."""

MAX_VISER_BYTES = 4 << 10
"""Maximum size of a message to viser."""

_fields_of = msgspec.msgpack.Decoder(dict[str, msgspec.Raw])
_decoders = {kind: msgspec.msgpack.Decoder(message_type(kind)) for kind in rules.SCENE}
_names = {kind: {"type", *(f.name for f in fields(message_type(kind)))} for kind in rules.SCENE}


def objection(data: str | bytes, role: Role) -> str | None:
    """Return the reason to keep a message of a browser with this role from viser, or None."""
    if not isinstance(data, bytes):
        return "text instead of bytes"
    if len(data) > MAX_VISER_BYTES:
        return f"{len(data)} bytes"
    try:
        raw = _fields_of.decode(data)
        kind = msgspec.msgpack.decode(raw.get("type", b"\xc0"), type=str)
        if kind not in rules.SCENE:
            return "unknown kind"
        if not raw.keys() <= _names[kind]:
            return f"a {kind} with unknown fields"
        values = vars(_decoders[kind].decode(data))
    except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        return str(error)
    if not all(map(_is_finite, values.values())):
        return f"a {kind} with a number that is not finite"
    return rules.refusal(role, kind) or None


def _is_finite(value: object) -> bool:
    if isinstance(value, tuple):
        return all(map(_is_finite, value))
    return not isinstance(value, float) or math.isfinite(value)
