"""Coordinate axes."""

from __future__ import annotations

import functools

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.api.nodes import Axes
from webviz.scene.glb import colored_glb
from webviz.scene.solids import SOLIDS, Solid
from webviz.scene.visual import Props, SingleNode, finite

COLORS = ((255, 0, 0), (0, 255, 0), (0, 0, 255))
"""Colours of x, y and z in RViz."""


class AxesVisual(SingleNode[Axes]):
    """All axes of a node in one draw call: instances of a model, since viser's axes are not lit."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Return a node without axes."""
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
        """Return the model, then poses and lengths; poses that are not finite are dropped.

        Browsers show nothing while they parse a new model, so it depends on proportions only.
        """
        positions, wxyzs = finite(node.positions, node.wxyzs)
        return (
            {"glb_data": _model(node.radius / node.length)},
            {
                "batched_positions": positions,
                "batched_wxyzs": wxyzs,
                "batched_scales": np.full(len(positions), node.length, np.float32),
            },
        )


@functools.lru_cache(maxsize=32)
def _model(radius: float) -> bytes:
    """Three cylinders of length 1 from the origin."""
    vertices, faces = SOLIDS["cylinder"]
    thin = np.array((2 * radius, 2 * radius, 1), np.float32)
    along_z = vertices * thin + np.array((0, 0, 0.5), np.float32)
    # Rolling the columns rotates the cylinder without mirroring it.
    parts = [Solid(np.roll(along_z, shift, axis=1), faces) for shift in (1, 2, 0)]
    return colored_glb(list(zip(parts, COLORS, strict=True)))
