"""Coordinate axes."""

from __future__ import annotations

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.nodes import Axes
from webviz.scene.drawn import Props, SingleNode, finite_rows


class AxesDrawn(SingleNode[Axes]):
    """All axes of a node in one draw call: viser's batched axes."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Makes a node without axes."""
        return scene.add_batched_axes(
            name, np.zeros((0, 4), np.float32), np.zeros((0, 3), np.float32)
        )

    def props(self, node: Axes) -> tuple[Props, ...]:
        """All in one set: a page that gets the look apart from the poses may lose the colours.

        Poses that are not finite are left out.
        """
        positions = np.ascontiguousarray(node.positions, dtype=np.float32)
        wxyzs = np.ascontiguousarray(node.wxyzs, dtype=np.float32)
        rows = finite_rows(positions, wxyzs)
        if rows is not None:
            positions, wxyzs = positions[rows], wxyzs[rows]
        return (
            {
                "batched_positions": positions,
                "batched_wxyzs": wxyzs,
                "axes_length": float(node.length),
                "axes_radius": float(node.radius),
            },
        )
