"""Binary glTF 2.0 for the scene; section numbers are those of Khronos' specification."""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Rgb
from webviz.edges.scene.lines import linear
from webviz.edges.scene.solids import Solid

_FLOAT, _UINT, _UBYTE = 5126, 5125, 5121
_VERTICES, _INDICES = 34962, 34963


def pack(content: dict[str, Any], rest: bytes = b"") -> bytes:
    """A binary glTF from its JSON and the following chunks (4.4)."""
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    length = 20 + len(text) + len(rest)
    return struct.pack("<4sIII4s", b"glTF", 2, length, len(text), b"JSON") + text + rest


def matte(glb: bytes) -> bytes:
    """Makes every material of a binary glTF non-metallic, as RViz draws meshes.

    Materials are metallic by default (5.22.3), and metal without an environment to reflect is
    black.

    Raises:
        ValueError: `glb` is not a binary glTF 2.0.
    """
    if len(glb) < 20 or glb[:8] != b"glTF\x02\0\0\0" or glb[16:20] != b"JSON":
        raise ValueError("The data is not a binary glTF 2.0.")
    end = 20 + int.from_bytes(glb[12:16], "little")
    content = json.loads(glb[20:end])
    materials = content.setdefault("materials", [])
    plain = len(materials)
    for mesh in content.get("meshes", []):
        for primitive in mesh["primitives"]:
            primitive.setdefault("material", plain)
    materials.append({})
    for material in materials:
        material.setdefault("pbrMetallicRoughness", {})["metallicFactor"] = 0.0
    return pack(content, glb[end:])


def colored_glb(parts: Sequence[tuple[Solid, Rgb]]) -> bytes:
    """One mesh of solids with a colour each; shading is smooth where faces share vertices."""
    counts = [len(solid.vertices) for solid, _ in parts]
    first = np.cumsum([0, *counts[:-1]])
    vertices = np.concatenate([solid.vertices for solid, _ in parts]).astype(np.float32)
    faces = np.concatenate([solid.faces + n for (solid, _), n in zip(parts, first, strict=True)])
    rgb = np.repeat(linear(np.array([color for _, color in parts], np.uint8)), counts, axis=0)
    rgba = np.concatenate((rgb, np.full((len(rgb), 1), 255, np.uint8)), axis=1)
    accessors: list[dict[str, Any]] = []
    views: list[dict[str, int]] = []
    data = b""
    for array, component, kind, target, more in (
        (vertices, _FLOAT, "VEC3", _VERTICES, _bounds(vertices)),
        (_normals(vertices, faces), _FLOAT, "VEC3", _VERTICES, {}),
        (rgba, _UBYTE, "VEC4", _VERTICES, {"normalized": True}),
        (faces.reshape(-1).astype(np.uint32), _UINT, "SCALAR", _INDICES, {}),
    ):
        view = {"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes, "target": target}
        accessor = {"componentType": component, "count": len(array), "type": kind}
        accessors.append({"bufferView": len(views), **accessor, **more})
        views.append(view)
        data += array.tobytes()  # each a multiple of four bytes
    attributes = {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2}
    content = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 3, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.0}}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data)}],
    }
    return pack(content, struct.pack("<I4s", len(data), b"BIN\0") + data)


def _bounds(vertices: NDArray[np.float32]) -> dict[str, list[float]]:
    return {"min": vertices.min(axis=0).tolist(), "max": vertices.max(axis=0).tolist()}


def _normals(vertices: NDArray[np.float32], faces: NDArray[np.uint32]) -> NDArray[np.float32]:
    """The mean normal of the faces around each vertex, weighted by area."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.zeros_like(vertices)
    np.add.at(normals, faces, np.cross(b - a, c - a)[:, None])
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
