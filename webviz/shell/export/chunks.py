"""Parts of a recorded run: each can be shown alone, and is compressed."""

from __future__ import annotations

import json
import math
import zlib
from collections.abc import Mapping, Sequence
from typing import Any

import msgspec
import numpy as np

from webviz.scene.adapter.tape import SceneMessage
from webviz.server.sending.outbox import BULK_BYTES
from webviz.server.sending.thinning import chosen

LEVEL = 9
"""Level of compression: a twentieth smaller than the usual one, for half a second a minute of a
run."""
SHARED_BYTES = 1 << 10
"""Columns of values from this size on have the numbers of their items, each of which a chunk has
once: compression does not see as far back as the trail with one point less."""
COLUMN = b'{"each":['
ALIGNMENT = 8
"""Bytes; browsers make numbers only of what is aligned."""
SHUFFLED_BYTES = 256
"""Arrays from this size on have the first bytes of all their numbers first, then the second ones
and so on, which compresses floats by a third more."""


class _Buffer(msgspec.Struct, frozen=True):
    """Bytes of a chunk.

    Args:
        data: an array, or bytes.
        width: size of its numbers in bytes if these are shuffled, else 1.
        rows: how many points it has, 0 if it is not of a cloud.
        kind: of buffers that are alike, and compressed side by side.
    """

    data: memoryview
    width: int
    rows: int = 0
    kind: str = ""

    def packed(self, every: int) -> bytes:
        """Return the bytes as they are compressed, of a cloud with one of `every` points."""
        flat = np.frombuffer(self.data, np.uint8)
        if self.rows and every > 1:
            flat = flat.reshape(self.rows, -1)[chosen(self.rows, every)].ravel()
        if self.width > 1:
            flat = np.ascontiguousarray(flat.reshape(-1, self.width).T)
        return flat.tobytes()


class Buffers:
    """The binary part of a chunk."""

    def __init__(self) -> None:
        self._all: list[_Buffer] = []
        self.size = 0
        """Bytes before compression."""

    def add(
        self,
        data: memoryview | bytes,
        dtype: str = "",
        rows: int = 0,
        kind: str = "",
    ) -> int:
        """Add an array or bytes; its number."""
        view = memoryview(data)
        item = np.dtype(dtype).itemsize if dtype else 1
        width = item if item > 1 and view.nbytes >= SHUFFLED_BYTES else 1
        self._all.append(_Buffer(view, width, rows, kind))
        self.size += view.nbytes
        return len(self._all) - 1

    def packed(self, every: int) -> tuple[list[tuple[int, int, int]], bytes]:
        """Start, size and width of each, and all of them."""
        whole, index = bytearray(), [(0, 0, 1)] * len(self._all)
        for number, buffer in sorted(enumerate(self._all), key=lambda each: each[1].kind):
            data = buffer.packed(every)
            whole += bytes(-len(whole) % ALIGNMENT)
            index[number] = len(whole), len(data), buffer.width
            whole += data
        return index, bytes(whole)


class _Column(msgspec.Struct):
    """The values of many items; see `webviz.engine.pipeline.selectable`."""

    each: list[msgspec.Raw]


class ExportChunk(msgspec.Struct):
    """Some seconds of a run.

    Args:
        first_message, first_value, first_picture: numbers of the first of each within.
        start: what is shown at its first frame: numbers of messages in order, of values by store
            and key, and of pictures by display.
    """

    first_message: int
    first_value: int
    first_picture: int
    start: Mapping[str, Any] = msgspec.field(default_factory=dict[str, Any])
    messages: list[Any] = msgspec.field(default_factory=list[Any])
    values: list[tuple[str, msgspec.Raw]] = msgspec.field(
        default_factory=list[tuple[str, msgspec.Raw]]
    )
    pictures: list[int] = msgspec.field(default_factory=list[int])
    frames: list[Any] = msgspec.field(default_factory=list[Any])
    buffers: Buffers = msgspec.field(default_factory=Buffers)
    shared: dict[bytes, int] = msgspec.field(default_factory=dict[bytes, int])
    json_bytes: int = 0
    has_clouds: bool = False

    @property
    def size(self) -> int:
        """Approximate number of bytes before compression."""
        return self.buffers.size + self.json_bytes

    def add_message(self, message: SceneMessage) -> None:
        """Add a message of the scene."""
        rows = _points_of(message)
        self.has_clouds |= rows > 0
        own = [
            self.buffers.add(
                data,
                dtype,
                rows if (data.shape or ())[:1] == (rows,) else 0,
                f"{place} {message.key}",
            )
            for place, (data, dtype) in enumerate(
                zip(message.buffers, _dtypes(message.content), strict=True)
            )
        ]
        content = _plain(message.content, own, self.buffers)
        encoded = msgspec.json.encode([message.key, message.node, message.phase, content])
        self.json_bytes += len(encoded)
        self.messages.append(msgspec.Raw(encoded))

    def add_value(self, kind: str, value: msgspec.Raw) -> None:
        """Add a value of a store; those of a kind are alike, and compressed side by side."""
        data = bytes(value)
        if len(data) >= SHARED_BYTES and data.startswith(COLUMN):
            value = self._with_shared(data)
        self.json_bytes += len(bytes(value))
        self.values.append((kind, value))

    def _with_shared(self, column: bytes) -> msgspec.Raw:
        """Return a column with the numbers of its items."""
        numbers: list[int] = []
        for item in msgspec.json.decode(column, type=_Column).each:
            data = bytes(item)
            if data not in self.shared:
                self.shared[data] = len(self.shared)
                self.json_bytes += len(data)
            numbers.append(self.shared[data])
        return msgspec.Raw(msgspec.json.encode({"__each": numbers}))

    def add_picture(self, data: bytes) -> None:
        """Add a picture of a pane as pages receive it."""
        self.pictures.append(self.buffers.add(data))

    def packed(self, every: int = 1) -> bytes:
        """Return the chunk as the page reads it: gzip of JSON's length, the JSON and the arrays.

        Args:
            every: of how many points of large clouds one is kept.
        """
        index, arrays = self.buffers.packed(every)
        order = sorted(range(len(self.values)), key=lambda number: self.values[number][0])
        places = {number: place for place, number in enumerate(order)}
        text = msgspec.json.encode(
            {
                "messages": {"first": self.first_message, "items": self.messages},
                "values": {
                    "first": self.first_value,
                    "items": [self.values[number][1] for number in order],
                    "places": [places[number] for number in range(len(order))],
                    "shared": [msgspec.Raw(data) for data in self.shared],
                },
                "pictures": {"first": self.first_picture, "items": self.pictures},
                "start": self.start,
                "frames": self.frames,
                "buffers": index,
            }
        )
        head = len(text).to_bytes(4, "little") + text
        head += bytes(-len(head) % ALIGNMENT)
        packer = zlib.compressobj(LEVEL, wbits=31)
        return packer.compress(head) + packer.compress(arrays) + packer.flush()


def _points_of(message: SceneMessage) -> int:
    """Return the number of points of a message of a large cloud, 0 of others."""
    updates = message.content.get("updates")
    points = updates.get("points") if isinstance(updates, Mapping) else None
    if not isinstance(points, Mapping) or "__binary_index" not in points:
        return 0
    data = message.buffers[points["__binary_index"]]
    return data.shape[0] if data.ndim == 2 and data.nbytes > BULK_BYTES else 0


def _dtypes(value: Any) -> list[str]:
    """Return the types of the arrays of a message, in the order of their numbers."""
    by_index: dict[int, str] = {}

    def walk(each: Any) -> None:
        if isinstance(each, Mapping):
            if "__binary_index" in each:
                by_index[each["__binary_index"]] = each["dtype"]
            else:
                for inner in each.values():
                    walk(inner)
        elif isinstance(each, list | tuple):
            for inner in each:
                walk(inner)

    walk(value)
    return [by_index[number] for number in sorted(by_index)]


def _plain(value: Any, numbers: Sequence[int], buffers: Buffers) -> Any:
    """Return a value for JSON: arrays and bytes by their number, non-finite floats as texts."""
    if isinstance(value, Mapping):
        if "__binary_index" in value:
            return {"__array": numbers[value["__binary_index"]], "dtype": value["dtype"]}
        return {str(key): _plain(each, numbers, buffers) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each, numbers, buffers) for each in value]
    if isinstance(value, bytes | bytearray | memoryview):
        return {"__array": buffers.add(bytes(value)), "dtype": "|u1"}
    if isinstance(value, float) and not math.isfinite(value):
        return {"__float": str(value)}
    if isinstance(value, str) and not value.isascii():
        return msgspec.Raw(json.dumps(value).encode())  # which may hold half of a surrogate pair
    return value
