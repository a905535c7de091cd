"""Binary glTF 2.0: the container, and arrays in it; numbers are of Khronos' specification."""

from __future__ import annotations

import struct
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

_START = struct.Struct("<4sIII4s")
"""The header of the file, then that of its first chunk (4.4)."""
_COMPONENTS = {"f": 5126, "I": 5125, "B": 5121}
_WIDTHS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_VERTICES, _INDICES = 34962, 34963


def pack(document: dict[str, Any], rest: bytes = b"") -> bytes:
    """Return a binary glTF from its JSON and the following chunks."""
    text = msgspec.json.encode(document)
    text += b" " * (-len(text) % 4)
    size = _START.size + len(text) + len(rest)
    return _START.pack(b"glTF", 2, size, len(text), b"JSON") + text + rest


def unpack(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the JSON of a binary glTF, and the following chunks.

    Raises:
        ValueError: it is not one.
    """
    if len(data) < _START.size or data[:8] != b"glTF\x02\0\0\0" or data[16:20] != b"JSON":
        raise ValueError("The data is not a binary glTF 2.0.")
    end = _START.size + int.from_bytes(data[12:16], "little")
    try:
        return msgspec.json.decode(data[_START.size : end]), data[end:]
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ValueError("The JSON of the binary glTF is invalid.") from error


def pack_with(document: dict[str, Any], binary: bytes) -> bytes:
    """Return a binary glTF from its JSON, but for `buffers`, and its one buffer."""
    buffers = [{"byteLength": len(binary)}]
    chunk = struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return pack({**document, "buffers": buffers}, chunk)


class Buffer:
    """Collects the arrays of a file: its accessors, their views, and the bytes."""

    def __init__(self) -> None:
        self._accessors: list[dict[str, Any]] = []
        self._views: list[dict[str, int]] = []
        self._data = bytearray()

    def add(self, array: NDArray[Any], bounds: bool = False, **more: Any) -> int:
        """Add values of vertices (N, 1) to (N, 4), or uint32 corners of faces (M, 3).

        Args:
            array: float32 or uint8, or uint32 for faces.
            bounds: whether to say between which values they are, as of positions (3.7.2.1).
            more: of the accessor, such as `normalized`.

        Returns:
            The number of their accessor.
        """
        is_faces = array.dtype == np.uint32
        rows = array.reshape(-1, 1) if is_faces else array
        data = np.ascontiguousarray(rows).tobytes()
        view = self.add_bytes(data, target=_INDICES if is_faces else _VERTICES)
        component, width = _COMPONENTS[array.dtype.char], _WIDTHS[rows.shape[1]]
        accessor = {"bufferView": view, "componentType": component, "count": len(rows)}
        if bounds:
            more |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
        self._accessors.append({**accessor, "type": width, **more})
        return len(self._accessors) - 1

    def add_bytes(self, data: bytes, **more: int) -> int:
        """Add bytes, such as an image; returns the number of their view."""
        view = {"buffer": 0, "byteOffset": len(self._data), "byteLength": len(data)}
        self._views.append({**view, **more})
        self._data += data + bytes(-len(data) % 4)
        return len(self._views) - 1

    def packed(self, primitives: list[dict[str, Any]], **more: Any) -> bytes:
        """Return a binary glTF of one mesh of these primitives, with more JSON like `materials`."""
        document = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": primitives}],
            "accessors": self._accessors,
            "bufferViews": self._views,
            **more,
        }
        return pack_with(document, bytes(self._data))
