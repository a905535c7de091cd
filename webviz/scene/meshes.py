"""Triangle meshes and glTF models."""

from __future__ import annotations

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.api.nodes import F32, U8, Glb, Mesh, Models
from webviz.data.gltf import pack
from webviz.scene.glb import matte
from webviz.scene.visual import Props, SingleNode, finite, finite_rows

COLORFUL = "toon5"
"""viser's material of meshes with a colour for each vertex, of which only the name is left."""
FLAT = "toon3"
"""Material of flat meshes, likewise."""


class MeshVisual(SingleNode[Mesh]):
    """A mesh, lit from both sides as RViz lights its triangle lists."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Return a mesh without faces."""
        return scene.add_mesh_simple(
            name,
            np.zeros((1, 3), np.float32),
            np.zeros((0, 3), np.uint32),
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )

    def props(self, node: Mesh) -> tuple[Props, ...]:
        """Triangles, then the look; triangles with a vertex that is not finite are dropped.

        Raises:
            ValueError: there is not one colour for each vertex.
        """
        vertices = np.ascontiguousarray(node.vertices, dtype=np.float32)
        faces = np.ascontiguousarray(node.faces, dtype=np.uint32)
        rows = finite_rows(vertices)
        if not rows.all():
            vertices = np.where(rows[:, None], vertices, np.float32(0))
            faces = faces[rows[faces].all(axis=1)]
        if node.colors is not None:
            if len(node.colors) != len(vertices):
                counts = f"{len(node.colors)} colours for {len(vertices)} vertices"
                raise ValueError(f"A mesh has {counts}.")
            vertices = np.concatenate((vertices, _as_vertices(node.colors)))
        return {"vertices": vertices, "faces": faces}, _look(node)


def _look(node: Mesh) -> Props:
    """Transparent shapes of one colour show their front faces only, as in RViz."""
    if node.colors is not None:
        opacity = None if (node.colors[:, 3] == 255).all() else 1.0
        look = {"color": (255, 255, 255), "opacity": opacity, "side": "double"}
        return {**look, "material": COLORFUL}
    opacity = None if node.opacity >= 1 else float(node.opacity)
    side = "double" if opacity is None or node.is_flat else "front"
    material = FLAT if node.is_flat else "standard"
    return {"color": node.color, "opacity": opacity, "side": side, "material": material}


def _as_vertices(colors: U8) -> F32:
    """Colours (N, 4) as further vertices, which have no face, float32 (N, 3); see colors.js.

    Each is (256 R + G) / 65536, (256 B + A) / 65536, 0. viser's meshes have one colour.
    """
    pairs = colors.astype(np.uint16)
    values = np.zeros((len(colors), 3), np.float32)
    values[:, :2] = (pairs[:, 0::2] << 8 | pairs[:, 1::2]) / np.float32(1 << 16)
    return values


class GlbVisual(SingleNode[Glb]):
    """A glTF model. Browsers show nothing while they parse a new one."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Return an empty model."""
        return scene.add_glb(name, _NOTHING, cast_shadow=False, receive_shadow=False)

    def props(self, node: Glb) -> tuple[Props, ...]:
        """Return the model.

        Raises:
            ValueError: `node.data` is not a binary glTF 2.0.
        """
        return ({"glb_data": matte(node.data)},)


class ModelsVisual(SingleNode[Models]):
    """Copies of a glTF model in one draw call: viser's batched models."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """No copies."""
        return scene.add_batched_glb(
            name,
            _NOTHING,
            np.zeros((0, 4), np.float32),
            np.zeros((0, 3), np.float32),
            batched_scales=np.zeros((0, 3), np.float32),
            lod="off",
            cast_shadow=False,
            receive_shadow=False,
        )

    def props(self, node: Models) -> tuple[Props, ...]:
        """Return the model, then its copies; those that are not finite are dropped.

        Raises:
            ValueError: `node.data` is not a binary glTF 2.0.
        """
        positions, wxyzs, scales = finite(node.positions, node.wxyzs, node.scales)
        copies = {"batched_positions": positions, "batched_wxyzs": wxyzs, "batched_scales": scales}
        return {"glb_data": matte(node.data)}, copies


_NOTHING = pack({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]})
