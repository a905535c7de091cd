"""Checks the messages of browsers: kinds, sizes and fields."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields
from typing import Any

import msgspec

from webviz.edges.scene import uploads
from webviz.edges.scene.adapter.widgets import message_type

MAX_BYTES = 4 << 20
"""Maximum size of a message; the longest is a config."""

SMALL = 4 << 10

# Messages that viser's page may send, with their maximum sizes. Deliberately missing are
# ShareUrlRequest, which opens a public tunnel, and pictures, which webviz does not request.
SIZES = {
    "CommandTriggerMessage": SMALL,
    uploads.PART: uploads.PART_BYTES + SMALL,
    uploads.START: SMALL,
    "GuiButtonHoldMessage": SMALL,
    "GuiFormDirtyMessage": SMALL,
    "GuiFormSubmitMessage": SMALL,
    "GuiUpdateMessage": 512 << 10,
    "SceneNodeClickMessage": SMALL,
    "SceneNodeDragMessage": SMALL,
    "ScenePointerMessage": SMALL,
    "TransformControlsDragEndMessage": SMALL,
    "TransformControlsDragStartMessage": SMALL,
    "TransformControlsUpdateMessage": SMALL,
    "ViewerCameraMessage": SMALL,
}

# Messages whose values are checked as well.
CHECKED = frozenset(
    {"GuiFormDirtyMessage", "GuiFormSubmitMessage", "GuiUpdateMessage", uploads.START}
)

Accepts = Callable[[dict[str, Any]], bool]

_fields_of = msgspec.msgpack.Decoder(dict[str, msgspec.Raw])
_decoders = {kind: msgspec.msgpack.Decoder(message_type(kind)) for kind in SIZES}
_names = {kind: {"type", *(f.name for f in fields(message_type(kind)))} for kind in SIZES}


class Judge:
    """Decides which messages of a browser reach viser.

    Args:
        accepts: whether a message in `CHECKED` is valid; takes its fields and its `type`.
    """

    def __init__(self, accepts: Accepts) -> None:
        self._accepts = accepts
        self._uploads = uploads.Uploads()

    def objection(self, data: str | bytes) -> str | None:
        """The reason to ignore a message, or None."""
        if not isinstance(data, bytes):
            return "text instead of bytes"
        try:
            raw = _fields_of.decode(data)
            kind = msgspec.msgpack.decode(raw.get("type", b"\xc0"), type=str)
            if kind not in SIZES:
                return "unknown kind"
            if len(data) > SIZES[kind]:
                return f"a {kind} of {len(data)} bytes"
            if not raw.keys() <= _names[kind]:
                return f"a {kind} with unknown fields"
            values = vars(_decoders[kind].decode(data))
        except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
            return str(error)
        if not all(map(_is_finite, values.values())):
            return f"a {kind} with a number that is not finite"
        message = {"type": kind, **values}
        if kind in CHECKED and not self._accepts(message):
            return f"a {kind} that no widget allows"
        if kind in (uploads.START, uploads.PART) and not self._uploads.accepts(message):
            return f"a {kind} that does not fit the announced files"
        return None


def _is_finite(value: object) -> bool:
    if isinstance(value, tuple):
        return all(map(_is_finite, value))
    return not isinstance(value, float) or math.isfinite(value)
