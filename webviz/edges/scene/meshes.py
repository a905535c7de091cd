"""Triangle meshes and glTF models."""

from __future__ import annotations

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.api.nodes import Glb, Mesh, Models
from webviz.edges.scene.drawn import Props, SingleNode, finite, finite_rows
from webviz.edges.scene.glb import matte, pack


class MeshDrawn(SingleNode[Mesh]):
    """A mesh of one colour, lit from both sides as RViz lights its triangle lists."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """A mesh without faces."""
        return scene.add_mesh_simple(
            name,
            np.zeros((1, 3), np.float32),
            np.zeros((0, 3), np.uint32),
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )

    def props(self, node: Mesh) -> tuple[Props, ...]:
        """Triangles, then the look; triangles with a vertex that is not finite are dropped."""
        vertices = np.ascontiguousarray(node.vertices, dtype=np.float32)
        faces = np.ascontiguousarray(node.faces, dtype=np.uint32)
        rows = finite_rows(vertices)
        if not rows.all():
            vertices = np.where(rows[:, None], vertices, np.float32(0))
            faces = faces[rows[faces].all(axis=1)]
        return {"vertices": vertices, "faces": faces}, _look(node)


def _look(node: Mesh) -> Props:
    """Transparent shapes show their front faces only, as in RViz."""
    if node.opacity >= 1:
        return {"color": node.color, "opacity": None, "side": "double"}
    return {"color": node.color, "opacity": float(node.opacity), "side": "front"}


class GlbDrawn(SingleNode[Glb]):
    """A glTF model. Browsers show nothing while they parse a new one."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """An empty model."""
        return scene.add_glb(name, _NOTHING, cast_shadow=False, receive_shadow=False)

    def props(self, node: Glb) -> tuple[Props, ...]:
        """The model.

        Raises:
            ValueError: `node.data` is not a binary glTF 2.0.
        """
        return ({"glb_data": matte(node.data)},)


class ModelsDrawn(SingleNode[Models]):
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
        """The model, then its copies; those that are not finite are dropped.

        Raises:
            ValueError: `node.data` is not a binary glTF 2.0.
        """
        positions, wxyzs, scales = finite(node.positions, node.wxyzs, node.scales)
        copies = {"batched_positions": positions, "batched_wxyzs": wxyzs, "batched_scales": scales}
        return {"glb_data": matte(node.data)}, copies


_NOTHING = pack({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]})
