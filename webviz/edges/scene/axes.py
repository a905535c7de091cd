"""Coordinate axes."""

from __future__ import annotations

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.api.nodes import Axes
from webviz.edges.scene.drawn import Props, SingleNode, finite_rows
from webviz.edges.scene.glb import colored_glb
from webviz.edges.scene.solids import SOLIDS, Solid

COLORS = ((204, 0, 0), (0, 204, 0), (0, 0, 204))
"""RViz's of x, y and z."""


class AxesDrawn(SingleNode[Axes]):
    """All axes of a node in one draw call: copies of a model, since viser's axes are not lit."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Makes a node without axes."""
        return scene.add_batched_glb(
            name,
            _model(0.1),
            np.zeros((0, 4), np.float32),
            np.zeros((0, 3), np.float32),
            batched_scales=np.zeros(0, np.float32),
            lod="off",
            cast_shadow=False,
            receive_shadow=False,
        )

    def props(self, node: Axes) -> tuple[Props, ...]:
        """The model, then where and how long the axes are; poses that are not finite are left out.

        Browsers show nothing while they parse a new model, so it depends on proportions alone.
        """
        positions = np.ascontiguousarray(node.positions, dtype=np.float32)
        wxyzs = np.ascontiguousarray(node.wxyzs, dtype=np.float32)
        rows = finite_rows(positions, wxyzs)
        if rows is not None:
            positions, wxyzs = positions[rows], wxyzs[rows]
        return (
            {"glb_data": _model(node.radius / node.length)},
            {
                "batched_positions": positions,
                "batched_wxyzs": wxyzs,
                "batched_scales": np.full(len(positions), node.length, np.float32),
            },
        )


def _model(radius: float) -> bytes:
    """Three cylinders of length 1 that begin at the origin."""
    vertices, faces = SOLIDS["cylinder"]
    thin = np.array((2 * radius, 2 * radius, 1), np.float32)
    along_z = vertices * thin + np.array((0, 0, 0.5), np.float32)
    # Rolled, x, y, z become y, z, x: no cylinder is mirrored.
    parts = [Solid(np.roll(along_z, shift, axis=1), faces) for shift in (1, 2, 0)]
    return colored_glb(list(zip(parts, COLORS, strict=True)))
