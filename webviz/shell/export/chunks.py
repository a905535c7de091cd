"""Parts of a recorded run: each can be shown by itself, and is compressed."""

from __future__ import annotations

import json
import math
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import msgspec
import numpy as np

from webviz.scene.adapter.tape import SceneMessage

ALIGNMENT = 8
"""Bytes; browsers make numbers only of what is aligned."""
LEVEL = 6
"""Of compression."""
SHUFFLED_BYTES = 256
"""Arrays from this size on have the first bytes of all their numbers first, then the second ones
and so on, which compresses floats by a third more."""


class Buffers:
    """The binary part of a chunk."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.index: list[tuple[int, int, int]] = []
        """Start and size in bytes of each, and the size of its numbers if these are shuffled."""

    def add(self, data: memoryview | bytes, dtype: str = "") -> int:
        """Add an array or bytes; its number."""
        size = len(data) if isinstance(data, bytes) else data.nbytes
        item = np.dtype(dtype).itemsize if dtype else 1
        width = item if item > 1 and size >= SHUFFLED_BYTES else 1
        self.data += bytes(-len(self.data) % ALIGNMENT)
        self.index.append((len(self.data), size, width))
        if width > 1:
            flat = np.frombuffer(data, np.uint8).reshape(-1, width)
            self.data += np.ascontiguousarray(flat.T).tobytes()
        else:
            self.data += data
        return len(self.index) - 1


@dataclass
class TapeChunk:
    """Some seconds of a run.

    Args:
        first_message, first_value, first_picture: numbers of the first of each within.
        start: what is shown at its first frame: numbers of messages in order, of values by store
            and key, and of pictures by display.
    """

    first_message: int
    first_value: int
    first_picture: int
    start: Mapping[str, Any] = field(default_factory=dict[str, Any])
    messages: list[Any] = field(default_factory=list[Any])
    values: list[msgspec.Raw] = field(default_factory=list[msgspec.Raw])
    pictures: list[int] = field(default_factory=list[int])
    frames: list[Any] = field(default_factory=list[Any])
    buffers: Buffers = field(default_factory=Buffers)
    json_bytes: int = 0

    @property
    def size(self) -> int:
        """About how many bytes it has before compression."""
        return len(self.buffers.data) + self.json_bytes

    def add_message(self, message: SceneMessage) -> None:
        """Add a message of the scene."""
        own = [
            self.buffers.add(data, dtype)
            for data, dtype in zip(message.buffers, _dtypes(message.content), strict=True)
        ]
        content = _plain(message.content, own, self.buffers)
        encoded = msgspec.json.encode([message.key, message.node, message.phase, content])
        self.json_bytes += len(encoded)
        self.messages.append(msgspec.Raw(encoded))

    def add_value(self, value: msgspec.Raw) -> None:
        """Add a value of a store."""
        self.json_bytes += len(bytes(value))
        self.values.append(value)

    def add_picture(self, data: bytes) -> None:
        """Add a picture of a pane as pages receive it."""
        self.pictures.append(self.buffers.add(data))

    def packed(self) -> bytes:
        """The chunk as the page reads it: gzip of the length of the JSON, of it and the arrays."""
        text = msgspec.json.encode(
            {
                "messages": {"first": self.first_message, "items": self.messages},
                "values": {"first": self.first_value, "items": self.values},
                "pictures": {"first": self.first_picture, "items": self.pictures},
                "start": self.start,
                "frames": self.frames,
                "buffers": self.buffers.index,
            }
        )
        head = len(text).to_bytes(4, "little") + text
        head += bytes(-len(head) % ALIGNMENT)
        packer = zlib.compressobj(LEVEL, wbits=31)
        return packer.compress(head) + packer.compress(self.buffers.data) + packer.flush()


def _dtypes(value: Any) -> list[str]:
    """The types of the arrays of a message, in the order of their numbers."""
    found: dict[int, str] = {}

    def walk(each: Any) -> None:
        if isinstance(each, Mapping):
            if "__binary_index" in each:
                found[each["__binary_index"]] = each["dtype"]
            else:
                for inner in each.values():
                    walk(inner)
        elif isinstance(each, list | tuple):
            for inner in each:
                walk(inner)

    walk(value)
    return [found[number] for number in sorted(found)]


def _plain(value: Any, numbers: Sequence[int], buffers: Buffers) -> Any:
    """A value for JSON: arrays and bytes by their number in the chunk, and floats that are none."""
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
