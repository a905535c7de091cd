"""Binary glTF 2.0 for the scene; section numbers are those of Khronos' specification."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Rgb
from webviz.data.gltf import Buffer, pack, unpack
from webviz.scene.lines import linear
from webviz.scene.solids import Solid


def matte(glb: bytes) -> bytes:
    """Make every material of a binary glTF non-metallic, as RViz draws meshes.

    Materials are metallic by default (5.22.3), and metal without an environment to reflect is
    black.

    Raises:
        ValueError: `glb` is not a binary glTF 2.0.
    """
    content, rest = unpack(glb)
    materials = content.setdefault("materials", [])
    plain = len(materials)
    for mesh in content.get("meshes", []):
        for primitive in mesh["primitives"]:
            primitive.setdefault("material", plain)
    materials.append({})
    for material in materials:
        material.setdefault("pbrMetallicRoughness", {})["metallicFactor"] = 0.0
    return pack(content, rest)


def colored_glb(parts: Sequence[tuple[Solid, Rgb]]) -> bytes:
    """One mesh of solids with a colour each; shading is smooth where faces share vertices."""
    counts = [len(solid.vertices) for solid, _ in parts]
    first = np.cumsum([0, *counts[:-1]])
    vertices = np.concatenate([solid.vertices for solid, _ in parts]).astype(np.float32)
    faces = np.concatenate([solid.faces + n for (solid, _), n in zip(parts, first, strict=True)])
    rgb = np.repeat(linear(np.array([color for _, color in parts], np.uint8)), counts, axis=0)
    rgba = np.concatenate((rgb, np.full((len(rgb), 1), 255, np.uint8)), axis=1)
    buffer = Buffer()
    attributes = {
        "POSITION": buffer.add(vertices, bounds=True),
        "NORMAL": buffer.add(_normals(vertices, faces)),
        "COLOR_0": buffer.add(rgba, normalized=True),
    }
    indices = buffer.add(faces.astype(np.uint32))
    materials = [{"pbrMetallicRoughness": {"metallicFactor": 0.0}}]
    primitive = {"attributes": attributes, "indices": indices, "material": 0}
    return buffer.packed([primitive], materials=materials)


def _normals(vertices: NDArray[np.float32], faces: NDArray[np.uint32]) -> NDArray[np.float32]:
    """Return the mean normal of the faces around each vertex, weighted by area."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.zeros_like(vertices)
    np.add.at(normals, faces, np.cross(b - a, c - a)[:, None])
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
