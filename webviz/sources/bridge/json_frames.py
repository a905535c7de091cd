"""Text frames of both protocols: JSON objects whose kind is in the field `op`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Generic, TypeVar

import msgspec

from webviz.data.words import plain
from webviz.sources.bridge.session import WireError

MAX_TEXT = 64 << 20
"""Characters of a frame, or of all fragments of one."""

M = TypeVar("M", bound=msgspec.Struct)


class _Op(msgspec.Struct):
    op: str


_OP = msgspec.json.Decoder(_Op)


class JsonFrames(Generic[M]):
    """Reads the text frames of a protocol.

    Args:
        kinds: of the messages that are used, by `op`.
    """

    def __init__(self, kinds: Mapping[str, type[M]]) -> None:
        self._decoders = {op: msgspec.json.Decoder(kind) for op, kind in kinds.items()}

    def read(self, text: str) -> M | None:
        """Return the message in a frame, None for one of a kind that is not used.

        Raises:
            WireError: it is not of the protocol.
        """
        if len(text) > MAX_TEXT:
            size, limit = len(text) >> 20, MAX_TEXT >> 20
            raise WireError(f"A text of {size} MB is above the limit of {limit} MB")
        try:
            decoder = self._decoders.get(_OP.decode(text).op)
            return decoder and decoder.decode(text)
        except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
            raise WireError(f"A text is not of the protocol: {plain(str(error), 120)}") from error
