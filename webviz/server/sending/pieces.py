"""Large messages in pieces, between which others are sent; `pieces.js` puts them together."""

from __future__ import annotations

from typing import Any, Protocol

import msgspec
import numpy as np

ALIGNMENT = 8
"""Bytes; browsers make numbers only of what is aligned."""


class Update(Protocol):
    """A message that assigns properties of a node."""

    @property
    def name(self) -> str:
        """Name of the node."""
        ...

    @property
    def updates(self) -> dict[str, Any]:
        """The properties by their names."""
        ...

    @property
    def owner(self) -> Any:
        """Whose node it is."""
        ...


class Piece(msgspec.Struct, frozen=True):
    """A part of the bytes of a message.

    Args:
        slot: number of the message among those of which pieces are under way.
        start: where it belongs.
        size: of all bytes.
        data: its bytes.
        update: what the bytes are for, only of the last piece.
        name: of the node that the message changes.
    """

    slot: int
    start: int
    size: int
    data: memoryview
    update: dict[str, Any] | None
    name: str = ""
    excluded_self_client: None = None

    def as_serializable_dict(
        self, binary_buffers: list[memoryview] | None = None
    ) -> dict[str, Any]:
        """Return the piece as viser packs messages, with bytes beside them."""
        assert binary_buffers is not None
        binary_buffers.append(self.data)
        data = {"__binary_index": len(binary_buffers) - 1, "dtype": "|u1"}
        whole = {
            "type": "webviz:Piece",
            "slot": self.slot,
            "start": self.start,
            "size": self.size,
            "data": data,
        }
        return whole | ({} if self.update is None else {"update": self.update})


class Pieces:
    """The pieces of a message, each as large as there is room for when it is taken.

    Args:
        message: whose arrays do not change any more.
        slot: its number; see `Piece`.
    """

    def __init__(self, message: Update, slot: int) -> None:
        self.slot = slot
        data = bytearray()
        values: dict[str, Any] = {}
        for name, value in message.updates.items():
            if not isinstance(value, np.ndarray | bytes):
                values[name] = {"value": value}
                continue
            data += bytes(-len(data) % ALIGNMENT)
            start, dtype = len(data), ""
            if isinstance(value, bytes):
                data += value
            else:
                data += np.ascontiguousarray(value).data.cast("B")
                dtype = value.dtype.str
            values[name] = {"start": start, "end": len(data), "dtype": dtype}
        self._name = message.name
        self._data = memoryview(data)
        self._update = {"name": message.name, "owner": message.owner, "values": values}
        self._start = 0

    @property
    def is_over(self) -> bool:
        """Return whether all of them were taken."""
        return self._start >= len(self._data)

    def take(self, size: int) -> Piece:
        """Return the next piece, of at most `size` bytes."""
        start, self._start = self._start, self._start + size
        update = self._update if self.is_over else None
        data = self._data[start : self._start]
        return Piece(self.slot, start, len(self._data), data, update, name=self._name)
