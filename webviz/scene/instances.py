"""Many boxes, spheres or cylinders."""

from __future__ import annotations

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.api.nodes import F32, Instances
from webviz.scene.lines import linear
from webviz.scene.solids import SOLIDS
from webviz.scene.visual import Props, SingleNode, finite, rgb_array

_NONE = np.zeros((0, 3), np.float32)
_UNTURNED = np.array((1.0, 0.0, 0.0, 0.0), np.float32)


class InstancesVisual(SingleNode[Instances]):
    """All solids of a node in one draw call: viser's batched meshes."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Return a node without solids."""
        return scene.add_batched_meshes_simple(
            name,
            *SOLIDS["box"],
            np.zeros((0, 4), np.float32),
            _NONE,
            batched_scales=_NONE,
            batched_colors=(0, 0, 0),
            lod="off",
            cast_shadow=False,
            receive_shadow=False,
        )

    def props(self, node: Instances) -> tuple[Props, ...]:
        """Return the solid, poses with colours, and opacity.

        Instances that are not finite are dropped.

        A browser recreates the batch for a new solid or opacity, hence separate sets.
        """
        wxyzs = np.tile(_UNTURNED, (len(node.positions), 1)) if node.wxyzs is None else node.wxyzs
        positions, scales, wxyzs, colors, opacity = finite(
            node.positions, node.scales, wxyzs, along=(node.colors, node.opacity)
        )
        solid = SOLIDS[node.shape] if isinstance(node.shape, str) else node.shape
        return (
            {"vertices": solid.vertices, "faces": solid.faces},
            {"material": _material(node)},
            {
                "batched_positions": positions,
                "batched_wxyzs": wxyzs,
                "batched_scales": scales,
                "batched_colors": linear(rgb_array(colors, len(positions))),
            },
            _opacity(opacity),
        )


def _material(node: Instances) -> str:
    """Return the material of viser's whose name says how the solids are shaded; see shade.js."""
    if not node.is_data:
        return "standard"
    return "toon5" if node.shape in ("box", "square") else "toon3"


def _opacity(opacity: float | F32) -> Props:
    """Return the opacity of the material: browsers draw one faster than one per instance."""
    if isinstance(opacity, np.ndarray):
        each = np.ascontiguousarray(opacity, dtype=np.float32)
        return {"opacity": None, "batched_opacities": each}
    return {"opacity": None if opacity >= 1 else float(opacity), "batched_opacities": None}
