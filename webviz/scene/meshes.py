"""Triangle meshes and glTF models."""

from __future__ import annotations

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.nodes import Glb, Mesh
from webviz.scene.adapter import Adapter
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


class GlbDrawn:
    """A glTF model. A new model replaces the node; browsers show nothing while they parse it."""

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._name = name

    def draw(self, node: Glb) -> None:
        """Sends the model."""
        self._handle = self._link.server.scene.add_glb(
            self._name, node.data, cast_shadow=False, receive_shadow=False
        )

    def remove(self) -> None:
        """Takes the model off the scene."""
        self._handle.remove()
