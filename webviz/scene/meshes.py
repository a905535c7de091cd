"""Triangle meshes and glTF models."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.nodes import Glb, Mesh
from webviz.scene.drawn import Props, SingleNode, finite_rows


class MeshDrawn(SingleNode[Mesh]):
    """A mesh of one colour, lit from both sides as RViz lights its triangle lists."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Makes a mesh without faces."""
        return scene.add_mesh_simple(
            name,
            np.zeros((1, 3), np.float32),
            np.zeros((0, 3), np.uint32),
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )

    def props(self, node: Mesh) -> tuple[Props, ...]:
        """Triangles, then the look; triangles with a corner that is not finite are left out."""
        vertices = np.ascontiguousarray(node.vertices, dtype=np.float32)
        faces = np.ascontiguousarray(node.faces, dtype=np.uint32)
        rows = finite_rows(vertices)
        if rows is not None:
            vertices = np.where(rows[:, None], vertices, np.float32(0))
            faces = faces[rows[faces].all(axis=1)]
        return (
            {"vertices": vertices, "faces": faces},
            {"color": node.color, "opacity": None if node.opacity >= 1 else float(node.opacity)},
        )


class GlbDrawn(SingleNode[Glb]):
    """A glTF model. Browsers show nothing while they parse a new one."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Makes a model of nothing."""
        return scene.add_glb(name, _NOTHING, cast_shadow=False, receive_shadow=False)

    def props(self, node: Glb) -> tuple[Props, ...]:
        """The model.

        Raises:
            ValueError: `node.data` is no binary glTF 2.0.
        """
        return ({"glb_data": matte(node.data)},)


def matte(glb: bytes) -> bytes:
    """Makes every material of a binary glTF a non-metal, as RViz draws meshes.

    A material that does not say is metal by the standard (glTF 2.0, 5.22.3), and metal without
    surroundings to reflect is black.

    Raises:
        ValueError: `glb` is no binary glTF 2.0.
    """
    if len(glb) < 20 or glb[:8] != b"glTF\x02\0\0\0" or glb[16:20] != b"JSON":
        raise ValueError("This is no binary glTF 2.0.")
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
    return _glb(content, glb[end:])


def _glb(content: dict[str, Any], rest: bytes = b"") -> bytes:
    """A binary glTF 2.0 of its JSON and the chunks after that."""
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    length = 20 + len(text) + len(rest)
    return struct.pack("<4sIII4s", b"glTF", 2, length, len(text), b"JSON") + text + rest


_NOTHING = _glb({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]})
